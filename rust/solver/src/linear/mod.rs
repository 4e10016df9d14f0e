//! Linear algebra of the implicit step: the constant matrix, its inverse, and conjugate gradients.

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
