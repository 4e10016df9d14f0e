//! The physics of Boucle: cloth as particles and springs, or as a continuum, moved frame by frame.
//!
//! A [`Simulation`] holds [`Cloth`]s, which never change, and their state, which does. [`Simulation::advance`] is one frame:
//!
//! 1. plan: into how many steps the frame is cut, by the stability bound or by the tolerance ([`simulation`]),
//! 2. aim: pins, colliders, rest shapes, winds and water go from where they are to where they are to be at the frame's end,
//! 3. step after step ([`step`]): all forces are computed ([`system`]), then all particles move ([`method`]), then edges that are too
//!    long are held ([`limit`]), then every way that leads through something is cut short ([`contact`]),
//! 4. once more with more steps, if those were far too few,
//! 5. tear what is pulled too hard ([`tear`]) and count what passes through what ([`contact`]),
//! 6. certify: strain, energy and a hash of every position bit ([`Certificate`]).
//!
//! SI units, Z up, world space. State, forces and residuals are f64, search directions and factors f32. The same input gives the
//! same bits for any number of threads: every particle gathers its own forces in a fixed order, and nothing is summed across threads.
//! Every refusal is an [`Error`] of one sentence that names the object, the value and what is accepted.
//!
//! # In which order to read
//!
//! 1. [`cloth`], [`material`], [`state`], [`settings`]: what is given and what changes.
//! 2. [`law`]: the classic model, one spring and the springs of a mesh, and [`kernel`]: how they are computed fast.
//! 3. [`system`] and [`integrator`]: all forces, then all moves; [`stability`]: how long a step may be.
//! 4. [`limit`]: what keeps springs from stretching like rubber.
//! 5. [`implicit`], its Hessian and its preconditioners, and [`linear`]: steps of any length.
//! 6. [`fabric`]: the continuum of membrane and hinges.
//! 7. [`contact`], in the order of its own page.
//! 8. [`pins`], [`rest`], [`sewing`], [`force`]: what holds, shapes and pushes; [`tear`]: what parts.
//! 9. [`step`] and [`simulation`]: how all of it makes a frame; [`mod@checkpoint`]: how that goes on another day.
//!
//! [system.rs]: system/index.html
//! [law/spring.rs]: law/spring/index.html
//! [law/spring_network.rs]: law/spring_network/index.html
//! [law/continuum.rs]: law/continuum/index.html
//! [fabric/membrane.rs]: fabric/membrane/index.html
//! [fabric/hinge.rs]: fabric/hinge/index.html
//! [fabric/compliance.rs]: fabric/compliance/index.html
//! [fabric/variation.rs]: fabric/variation/index.html
//! [fabric/creases.rs]: fabric/creases/index.html
//! [fabric/mod.rs]: fabric/index.html
//! [limit/provot.rs]: limit/provot/index.html
//! [limit/project.rs]: limit/project/index.html
//! [implicit/taut.rs]: implicit/taut/index.html
//! [pins.rs]: pins/index.html
//! [goals.rs]: goals/index.html
//! [grab.rs]: grab/index.html
//! [rest.rs]: rest/index.html
//! [sewing.rs]: sewing/index.html
//! [force/pressure.rs]: force/pressure/index.html
//! [force/wind.rs]: force/wind/index.html
//! [force/flow.rs]: force/flow/index.html
//! [force/weather.rs]: force/weather/index.html
//! [force/shelter.rs]: force/shelter/index.html
//! [force/field/mod.rs]: force/field/index.html
//! [force/field/kinds.rs]: force/field/kinds/index.html
//! [force/field/noise.rs]: force/field/noise/index.html
//! [force/fields.rs]: force/fields/index.html
//! [force/field/falloff.rs]: force/field/falloff/index.html
//! [force/sea.rs]: force/sea/index.html
//! [force/hull.rs]: force/hull/index.html
//! [force/water.rs]: force/water/index.html
//! [contact/contact.rs]: contact/contact/index.html
//! [contact/friction.rs]: contact/friction/index.html
//! [contact/cut.rs]: contact/cut/index.html
//! [contact/recovery.rs]: contact/recovery/index.html
//! [contact/settling.rs]: contact/settling/index.html
//! [tear/mod.rs]: tear/index.html
//! [tear/carried.rs]: tear/carried/index.html
//! [tear/fan.rs]: tear/fan/index.html
//! [integrator/forward_euler.rs]: integrator/forward_euler/index.html
//! [integrator/symplectic_euler.rs]: integrator/symplectic_euler/index.html
//! [integrator/verlet.rs]: integrator/verlet/index.html
//! [integrator/leapfrog.rs]: integrator/leapfrog/index.html
//! [integrator/midpoint.rs]: integrator/midpoint/index.html
//! [integrator/rk4.rs]: integrator/rk4/index.html
//! [implicit/mod.rs]: implicit/index.html
//! [implicit/history.rs]: implicit/history/index.html
//! [implicit/substeps.rs]: implicit/substeps/index.html
//! [stability.rs]: stability/index.html
#![doc = include_str!("laws.md")]
#![allow(rustdoc::private_intra_doc_links, reason = "the lecture is built with private items")]

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
mod tear;
mod threads;

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
pub use tear::{Opening, Tear};
