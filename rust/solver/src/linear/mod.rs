//! Linear algebra of the implicit step: `H x = r` for the move x (m) of every particle.
//!
//! H is never written down; [`conjugate_gradient`] asks only for its products, and for something near its inverse:
//!
//! - [`laplacian`]: the constant matrix P, one number for each pair of particles, which stands for H of springs. It is inverted
//!   exactly by [`ldlt`], or, of very many particles, nearly by [`multigrid`].
//! - [`cholesky`]: the factor of a matrix of 3 x 3 blocks, which stands for H of fabric and is made anew for each guess.
//! - [`block_jacobi`] and [`chebyshev`]: smoothing around either.
//!
//! Both eliminations take their order from [`dissection`] and their structure from [`fronts`]. Vectors are [`field`]s; products
//! over pairs are laid out by [`pairs`] and [`links`]. All of this is f32, but for what `ldlt` factors in; no sum depends on
//! the number of threads.

mod block_jacobi;
pub(crate) mod chebyshev;
mod cholesky;
mod conjugate_gradient;
mod dissection;
mod field;
mod fronts;
mod laplacian;
mod ldlt;
mod links;
mod multigrid;
#[cfg(test)]
mod oracle;
mod pairs;
#[cfg(test)]
mod problems;

pub(crate) use block_jacobi::{BlockJacobi, Entries, LARGEST};
pub(crate) use cholesky::{BlockMatrix, Cholesky};
pub(crate) use conjugate_gradient::{ConjugateGradient, Inverse, Operator, Solved, Stop};
pub(crate) use field::Field;
pub(crate) use laplacian::{Forward, Graph, Laplacian};
pub(crate) use ldlt::Ldlt;
pub(crate) use links::{Link, Row};
pub(crate) use multigrid::Multigrid;
pub(crate) use pairs::{Block, Pairs};
