//! The classic mass-spring model: which springs a mesh has, how stiff they are, and how each answers deformation.
//!
//! [`spring`] is the law of one spring, [`spring_network`] finds the springs of a mesh, [`continuum`] shares a membrane's
//! stiffness out among them. Laws are written for a [`number`] of any width, so that the oracle of the tests and the vectors of
//! [`crate::kernel`] run the same lines. The law of fabric is in [`crate::fabric`].

mod continuum;
pub(crate) mod number;
pub(crate) mod spring;
mod spring_network;

pub use spring::Spring;
pub use spring_network::springs_of_mesh;
