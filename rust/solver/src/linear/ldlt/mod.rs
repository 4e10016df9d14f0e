//! Block `LDLᵀ`: the inverse of the constant matrix, for three right-hand sides at once.
//!
//! Blocks of the [`Dissection`](super::dissection) are eliminated children first. With S the dense matrix of a block
//! after its descendants are gone, and A the rows below it (its *front*: particles eliminated later that it touches),
//!
//! ```text
//! [S  Aᵀ]   [I  0] [S      ] [I  Wᵀ]
//! [A  U ] = [W  I] [   U - W Aᵀ] [0  I ]         W = A S⁻¹
//! ```
//!
//! S⁻¹ and W are stored as they are, so that a solve is nothing but dense products, with no recurrence inside a block:
//!
//! ```text
//! up     y = S⁻¹ b      children's shares taken from b first; -W b is this block's share of the front
//! down   x = y - Wᵀ x_front
//! ```
//!
//! It is factored in f64; S⁻¹ is stored in f32, and W in bf16, because a solve takes as long as its reading. Both sweeps
//! read the same W, so what they apply is the exact inverse of a matrix near the given one, symmetric and positive
//! definite as well: some thousandths off, which costs conjugate gradients no more than an iteration.
//!
//! Halves of the dissection never touch, so each is one task; what a task passes up is its own memory and is added in a
//! fixed order: the bits do not depend on the number of threads.
//!
//! Sources: multifrontal elimination after Duff & Reid 1983; a factor of low precision as preconditioner after Higham &
//! Pranesh 2021.

mod dense;
mod factor;
mod panel;
mod plan;
mod solve;
mod symbolic;

#[cfg(test)]
mod tests;

use boucle_geometry::Vector;
use pulp::Arch;

use super::conjugate_gradient::Inverse;
use super::field::Field;
use super::laplacian::{Graph, Laplacian};
use factor::Factor;
use solve::Workspace;
use symbolic::Symbolic;

/// A factored matrix and the memory that its solves need.
#[derive(Debug)]
pub(crate) struct Ldlt {
    symbolic: Symbolic,
    factor: Factor,
    workspace: Workspace,
    arch: Arch,
}

impl Ldlt {
    /// Orders a graph by the positions of its particles and factors a matrix on it.
    pub(crate) fn new(graph: &Graph, positions: &[Vector], matrix: &Laplacian) -> Self {
        let arch = Arch::new();
        let symbolic = Symbolic::new(graph, positions);
        let factor = Factor::new(&symbolic, graph, matrix, arch);
        let workspace = Workspace::new(&symbolic);
        Self { symbolic, factor, workspace, arch }
    }

    /// Factors another matrix on the same graph.
    pub(crate) fn refactor(&mut self, graph: &Graph, matrix: &Laplacian) {
        self.factor = Factor::new(&self.symbolic, graph, matrix, self.arch);
    }

    /// Numbers stored, padding included.
    #[cfg(test)]
    fn size(&self) -> usize {
        self.factor.inverse.len() * panel::LANES + self.factor.below.len() * panel::ROWS
    }
}

impl Inverse for Ldlt {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        self.workspace.solve(&self.symbolic, &self.factor, self.arch, r, z);
    }
}
