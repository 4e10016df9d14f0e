//! The inverse of the constant matrix P, kept until the step or the pins change.

use boucle_geometry::Vector;

use crate::cloth::Cloth;
use crate::linear::{Graph, Inverse, Laplacian, Ldlt};
use crate::material::SpringKind;
use crate::system::System;

/// P on the springs along edges and across faces. Bend springs are left to H: the factor is half as large without.
#[derive(Debug)]
pub(super) struct Preconditioner {
    graph: Graph,
    pairs: Vec<[u32; 2]>,
    /// Stiffness (N/m) and damping (N·s/m) of each pair.
    springs: Vec<[f64; 2]>,
    /// Rest positions (m), to order by.
    positions: Vec<Vector>,
    /// What is factored, and for which step (s); 0 for none.
    factored: Option<Ldlt>,
    step: f64,
}

impl Preconditioner {
    pub(super) fn new(cloths: &[Cloth]) -> Self {
        let (mut pairs, mut springs, mut positions) = (Vec::new(), Vec::new(), Vec::new());
        for cloth in cloths {
            let base = positions.len() as u32;
            positions.extend_from_slice(&cloth.positions);
            for spring in cloth.springs.iter().filter(|spring| spring.kind != SpringKind::Bend) {
                pairs.push(spring.ends.map(|end| base + end));
                springs.push([spring.stiffness, spring.damping]);
            }
        }
        let graph = Graph::new(positions.len(), &pairs);
        Self { graph, pairs, springs, positions, factored: None, step: 0.0 }
    }

    /// The inverse for steps of h' seconds.
    pub(super) fn inverse(&mut self, system: &System, h: f64) -> &mut dyn Inverse {
        let is_fresh = self.step.to_bits() == h.to_bits();
        let matrix = (!is_fresh).then(|| self.matrix(system, h));
        self.step = h;
        let Self { factored, graph, positions, .. } = self;
        if let (Some(ldlt), Some(matrix)) = (factored.as_mut(), &matrix) {
            ldlt.refactor(graph, matrix);
        }
        factored.get_or_insert_with(|| {
            let none = Laplacian::default();
            Ldlt::new(graph, positions, matrix.as_ref().unwrap_or(&none))
        })
    }

    /// Factors anew at the next step: pins have changed.
    pub(super) fn forget(&mut self) {
        self.step = 0.0;
    }

    fn matrix(&self, system: &System, h: f64) -> Laplacian {
        let weights = self.springs.iter().map(|[stiffness, damping]| stiffness + damping / h);
        let still = system.air.damping();
        let diagonal = system.masses.iter().zip(&system.air_damping);
        let diagonal = diagonal.map(|(mass, damping)| mass / (h * h) + (damping + still) / h);
        Laplacian::new(&self.pairs, weights.collect(), diagonal.collect(), |particle| {
            system.is_pinned(particle)
        })
    }
}
