//! The preconditioner of a step: P⁻¹ between two smoothings with the blocks on H's diagonal.
//!
//! P takes every spring as stiff in all directions. Cloth is soft across: there P is far above H, and P⁻¹ alone leaves
//! folding and swinging to many iterations. The 3 x 3 blocks of H know the soft direction of each particle. So first
//! Chebyshev steps with them, then P⁻¹ on what is left, then the same steps once more:
//!
//! ```text
//! z = C r        z += P⁻¹ (r - H z)        z += C (r - H z)
//! ```
//!
//! with H without its bend springs. That is symmetric and positive definite for any P: the sum of what the steps of C do
//! together, and of P⁻¹ between a matrix and its transpose.
//!
//! P knows nothing of contacts either. Where they press or stick, P⁻¹ would move a particle as if it were free, and that move
//! would set the length of all others. So each particle is made heavier in the place of H's contacts, in which
//! `L Lᵀ = I + C/(m/h'²)`, C the block that contacts add to it: `z += L⁻ᵀ P⁻¹ L⁻¹ (r - H z)`.
//!
//! Hanging sheets take a quarter of the iterations that P⁻¹ alone takes, and have a smaller error when they stop. With one
//! step in the place of two they take a third more.

use crate::contact::ContactMatrix;
use crate::linear::{BlockJacobi, Field, Inverse, chebyshev};

use super::hessian::Product;

/// Chebyshev steps before and after.
const STEPS: usize = 2;

/// They work on eigenvalues from this part of the largest up.
const SMOOTHED: f32 = 0.125;

/// Vectors of one application.
#[derive(Debug)]
pub(super) struct Scratch {
    left: Field,
    step: Field,
}

impl Scratch {
    pub(super) fn new(count: usize) -> Self {
        Self { left: Field::zeros(count), step: Field::zeros(count) }
    }
}

/// The preconditioner, of what it is made.
pub(super) struct Smoothed<'a> {
    /// Without bend springs.
    pub(super) matrix: &'a Product<'a>,
    /// Those that the inverse in the middle does not know.
    pub(super) contacts: Option<&'a ContactMatrix>,
    pub(super) blocks: &'a BlockJacobi,
    pub(super) inverse: &'a mut dyn Inverse,
    /// Bound of the eigenvalues of the matrix times the inverse of its blocks.
    pub(super) largest: f32,
    pub(super) scratch: &'a mut Scratch,
}

impl Inverse for Smoothed<'_> {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        let Self { matrix, contacts, blocks, inverse, largest, scratch } = self;
        let (Scratch { left, step }, largest) = (&mut **scratch, *largest);
        left.copy_from(r);
        z.fill(0.0);
        let smooth = || chebyshev::steps(SMOOTHED * largest, largest).take(STEPS);
        for factors in smooth() {
            blocks.relax(factors, left, step, z);
            matrix.subtract(step, left);
        }
        let heavy = contacts.map(|contacts| contacts.lighten(left));
        inverse.apply_inverse(left, step);
        if let (Some(contacts), Some(heavy)) = (contacts, heavy) {
            contacts.lighten_transposed(step);
            contacts.put_back(&heavy, left);
        }
        z.update(step, |z, step| *z += step);
        for factors in smooth() {
            matrix.subtract(step, left);
            blocks.relax(factors, left, step, z);
        }
    }
}
