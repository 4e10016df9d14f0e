//! Laws: how a piece of cloth answers deformation.

mod continuum;
pub(crate) mod number;
pub(crate) mod spring;
mod spring_network;

pub use spring::Spring;
pub use spring_network::springs_of_mesh;
