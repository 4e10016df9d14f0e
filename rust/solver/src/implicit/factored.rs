//! The Hessian itself as a preconditioner, factored at each guess: for fabric.
//!
//! P takes a yarn's stiffness in tension for all directions. Shear and compression of woven cloth are a hundredth of that or
//! less, and P⁻¹ leaves them to hundreds of iterations; what those leave of the strain asks for smaller steps. With the
//! Hessian's own factor two to five iterations do, and steps are two to four times as long.
//!
//! Of hinges it has a bound along edges: with their wings the factor would be eight times the work. Smoothing around it knows them:
//! without, 128² takes twice the iterations, and a cantilever stops 13 % short of where it hangs.

use super::hessian::{Hessian, Pattern};
use super::preconditioner::Preconditioner;
use crate::contact::ContactMatrix;
use crate::linear::{BlockMatrix, Cholesky};
use crate::system::System;

/// The factor and what it is made from.
#[derive(Debug)]
pub(super) struct Factored {
    pattern: Pattern,
    matrix: BlockMatrix,
    cholesky: Cholesky,
}

impl Factored {
    /// For the same pairs of particles as P.
    pub(super) fn new(preconditioner: &Preconditioner, system: &System) -> Self {
        let Preconditioner { graph, pairs, positions, .. } = preconditioner;
        Self {
            pattern: Pattern::new(pairs, system),
            matrix: BlockMatrix::default(),
            cholesky: Cholesky::new(graph, positions),
        }
    }

    /// The inverse of the Hessian, with a bound of what bends; contacts count twice on its diagonal and nowhere else.
    pub(super) fn inverse(
        &mut self,
        hessian: &Hessian,
        system: &System,
        contacts: &ContactMatrix,
    ) -> &mut Cholesky {
        hessian.write(&self.pattern, system, contacts, &mut self.matrix);
        self.cholesky.factor(&self.matrix, &hessian.inertia);
        &mut self.cholesky
    }
}
