//! The inverse of the constant matrix P, kept until the step or the pins change.

use boucle_geometry::Vector;

use crate::cloth::Cloth;
use crate::linear::{Field, Graph, Inverse, Laplacian, Ldlt, Operator};
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
    matrix: Laplacian,
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
        Self { graph, pairs, springs, positions, factored: None, step: 0.0, matrix: Laplacian::default() }
    }

    /// The inverse for steps of h' seconds.
    pub(super) fn inverse(&mut self, system: &System, h: f64) -> &mut dyn Inverse {
        let is_fresh = self.step.to_bits() == h.to_bits();
        if !is_fresh {
            self.matrix = self.matrix(system, h);
            self.step = h;
        }
        let Self { factored, graph, positions, matrix, .. } = self;
        if let (Some(ldlt), false) = (factored.as_mut(), is_fresh) {
            ldlt.refactor(graph, matrix);
        }
        factored.get_or_insert_with(|| Ldlt::new(graph, positions, matrix))
    }

    /// The inverse of the last step, and the matrix itself.
    pub(super) fn both(&mut self) -> (&mut dyn Inverse, Forward<'_>) {
        let Self { factored, graph, positions, matrix, .. } = self;
        let inverse = factored.get_or_insert_with(|| Ldlt::new(graph, positions, matrix));
        (inverse, Forward { graph, matrix })
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

/// The product with P itself.
#[derive(Clone, Copy)]
pub(super) struct Forward<'a> {
    graph: &'a Graph,
    matrix: &'a Laplacian,
}

impl Operator for Forward<'_> {
    fn apply(&self, p: &Field, out: &mut Field) {
        self.matrix.multiply(self.graph, p, out);
    }
}
