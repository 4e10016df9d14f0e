//! The solver held to closed forms and to numbers that none of its code made.
//!
//! Each test is a true sentence about the public [`boucle_solver::Simulation`], and each tolerance says where it
//! comes from. The tables in `reference/` were computed independently, with numpy.

mod conservation;
mod contact_determinism;
mod contact_energy;
mod contact_friction;
mod contact_rules;
mod contact_scenes;
mod contact_things;
mod creases;
mod determinism;
mod drag;
mod dynamics;
mod fabric;
mod fields;
mod forces;
mod frame_ends;
mod implicit;
mod integrators;
mod interruption;
mod invariance;
mod lattice;
mod limiters;
mod lying;
mod pins;
mod plain;
mod pressure;
mod promise;
mod reference;
mod refusals;
mod resolution;
mod rest;
mod robustness;
mod scenes;
mod sewing;
mod sheets;
mod soft_pins;
mod stability;
mod statics;
mod swing;
mod told;
mod water;
mod weather;
mod wet;
mod wind;
