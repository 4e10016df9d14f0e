//! The inverse of the constant matrix P, kept until the step or the pins change.

use boucle_geometry::Vector;

use crate::cloth::{Cloth, placed};
use crate::fabric::Fabrics;
use crate::linear::{Forward, Graph, Inverse, Laplacian, Ldlt, Multigrid};
use crate::material::SpringKind;
use crate::settings::LinearSolver;
use crate::system::System;

/// Particles up to which `Auto` eliminates: beyond, a factor takes more memory than the rest of a cloth.
const MOST_EXACT: usize = 400_000;

/// What stands for the inverse.
#[derive(Debug)]
enum Kind {
    Exact(Ldlt),
    Cycle(Multigrid),
}

impl Kind {
    fn as_inverse(&mut self) -> &mut dyn Inverse {
        match self {
            Self::Exact(ldlt) => ldlt,
            Self::Cycle(cycle) => cycle,
        }
    }
}

/// P on the springs along edges and across faces. Bend springs are left to H: the factor is half as large without.
#[derive(Debug)]
pub(super) struct Preconditioner {
    pub(super) graph: Graph,
    pub(super) pairs: Vec<[u32; 2]>,
    /// Stiffness (N/m) and damping (N·s/m) of each pair.
    springs: Vec<[f64; 2]>,
    /// Rest positions (m), to order by.
    pub(super) positions: Vec<Vector>,
    /// What is ready, and for which step (s); 0 for none.
    inverse: Option<Kind>,
    choice: LinearSolver,
    step: f64,
    matrix: Laplacian,
}

impl Preconditioner {
    pub(super) fn new(cloths: &[Cloth], fabrics: &Fabrics, choice: LinearSolver) -> Self {
        let (mut pairs, mut positions) = (Vec::new(), Vec::new());
        for (cloth, base) in placed(cloths) {
            positions.extend_from_slice(&cloth.positions);
            for spring in cloth.springs.iter().filter(|spring| spring.kind != SpringKind::Bend) {
                pairs.push(spring.ends.map(|end| base + end));
            }
        }
        let springs = weights(&pairs, cloths, fabrics);
        let graph = Graph::new(positions.len(), &pairs);
        Self {
            graph,
            pairs,
            springs,
            positions,
            inverse: None,
            choice,
            step: 0.0,
            matrix: Laplacian::default(),
        }
    }

    /// The inverse for steps of h' seconds.
    pub(super) fn inverse(&mut self, system: &System, h: f64) -> &mut dyn Inverse {
        self.both(system, h).0
    }

    /// The inverse and the matrix itself.
    pub(super) fn both(&mut self, system: &System, h: f64) -> (&mut dyn Inverse, Forward<'_>) {
        let is_fresh = self.step.to_bits() == h.to_bits();
        if !is_fresh {
            self.matrix = self.matrix(system, h);
            self.step = h;
        }
        let is_exact = match self.choice {
            LinearSolver::Auto => self.positions.len() <= MOST_EXACT,
            LinearSolver::Ldlt => true,
            LinearSolver::Multigrid => false,
        };
        let Self { inverse, graph, positions, matrix, pairs, .. } = self;
        let kind = match inverse.take() {
            Some(kind) if is_fresh => kind,
            Some(Kind::Exact(mut ldlt)) => {
                ldlt.refactor(graph, matrix);
                Kind::Exact(ldlt)
            }
            _ if is_exact => Kind::Exact(Ldlt::new(graph, positions, matrix)),
            _ => {
                let is_pinned = |particle: usize| system.is_pinned(particle);
                Kind::Cycle(Multigrid::new(pairs, matrix, positions, is_pinned))
            }
        };
        (inverse.insert(kind).as_inverse(), Forward { graph, matrix })
    }

    /// Takes the present stiffness of the cloths' springs.
    pub(super) fn follow_stiffness(&mut self, cloths: &[Cloth], fabrics: &Fabrics) {
        self.springs = weights(&self.pairs, cloths, fabrics);
        self.forget();
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
        let mut diagonal: Vec<f64> = diagonal.collect();
        for (particle, tangent) in system.goals.tangents(h) {
            diagonal[particle] += tangent;
        }
        Laplacian::new(&self.pairs, weights.collect(), diagonal, |particle| {
            system.is_pinned(particle)
        })
    }
}

/// Stiffness (N/m) and damping (N·s/m) of each pair: those of its spring and of the triangles beside it.
fn weights(pairs: &[[u32; 2]], cloths: &[Cloth], fabrics: &Fabrics) -> Vec<[f64; 2]> {
    let springs = cloths.iter().flat_map(|cloth| &cloth.springs);
    let springs = springs.filter(|spring| spring.kind != SpringKind::Bend);
    let of_triangles = fabrics.weights();
    let weights = springs.zip(pairs).map(|(spring, &[a, b])| {
        let pair = [a.min(b), a.max(b)];
        let place = of_triangles.binary_search_by_key(&pair, |(pair, _)| *pair);
        let [stiffness, damping] = place.map_or([0.0; 2], |place| of_triangles[place].1);
        [spring.stiffness + stiffness, spring.damping + damping]
    });
    weights.collect()
}
