//! The physics of Boucle: cloth as particles and springs, moved frame by frame.
//!
//! A [`Simulation`] holds [`Cloth`]s, which never change, and their state, which does. One frame is
//!
//! 1. plan: how many substeps hold the stability bound ([`Settings::step_size`]),
//! 2. start the pins towards their targets,
//! 3. step: evaluate all forces, then move all particles, then limit strain, substep after substep,
//! 4. certify: strain, energy and a hash of every position bit ([`Certificate`]).
//!
//! SI units, Z up, world space, f64. The same input gives the same bits for any number of threads: every particle
//! gathers its own forces in a fixed order, and nothing is summed across threads.

mod aligned;
mod awake;
mod certificate;
mod checkpoint;
mod cloth;
mod collider;
mod collision;
mod contact;
mod digest;
mod error;
mod fabric;
mod force;
mod goals;
mod grab;
mod grouped;
mod implicit;
mod integrator;
mod interrupter;
mod kernel;
mod law;
mod limit;
mod linear;
mod material;
mod method;
mod overstretch;
mod perturbation;
mod pins;
mod rest;
mod scatter;
mod settings;
mod sewing;
mod simulation;
mod stability;
mod state;
mod step;
mod system;
mod tailoring;

pub use certificate::Certificate;
pub use cloth::{Cloth, Mass, mesh_of};
pub use collider::{Collider, Shape};
pub use collision::Collision;
pub use contact::Detection;
pub use error::{Error, Result};
pub use fabric::{Fabric, Warp};
pub use force::{
    Bulk, Falloff, FalloffShape, Field, FieldKind, FieldShape, Flow, Gusts, Pressure, Range,
    Region, Side, Turbulence, Water, Wave, Wind, WindLaw,
};
pub use interrupter::Interrupter;
pub use law::{Spring, springs_of_mesh};
pub use material::{DampingLaw, Limiter, PinMaterial, SpringKind, SpringMaterial, StiffnessFrom};
pub use overstretch::OverstretchedEdge;
pub use settings::{IntegratorKind, LinearSolver, MOST_SUBSTEPS, Settings, StepSize};
pub use simulation::Simulation;
pub use tailoring::{SHRINK, Sewing, Tailoring};
