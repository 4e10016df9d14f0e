//! Forces that are not springs, in N on each particle.
//!
//! - [`wind`] is the classic law and the law by area, whose faces feel a [`flow`]; [`weather`] makes it gust, [`shelter`] keeps it
//!   from what stands in the lee of colliders; [`winds`] are all of them.
//! - [`field`] and [`fields`] are Blender's force fields.
//! - [`pressure`] inflates a cloth; [`filling`] is what one cloth holds.
//! - [`water`] is the surface, [`sea`] carries and wets what is in it, [`hull`] carries what is closed.
//!
//! [`air`] adds all of them up, face by face ([`faces`]). Gravity and air damping are in [`crate::system`]. What an implicit step
//! needs besides, a bound of each force's slope, stands beside the force.

mod air;
mod faces;
mod field;
mod fields;
mod filling;
mod flow;
mod hull;
mod pressure;
mod sea;
mod shelter;
mod water;
mod weather;
mod wind;
mod winds;

pub(crate) use air::{Air, AirScratch};
pub(crate) use field::NUMBERS as FIELD_NUMBERS;
pub use field::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
pub(crate) use filling::Level;
pub use flow::Flow;
pub use pressure::Pressure;
pub(crate) use pressure::{PressureScratch, Pressures};
pub(crate) use sea::NUMBERS as SEA_NUMBERS;
pub use water::{Bulk, Water, Wave};
pub use weather::{Gusts, Turbulence};
pub(crate) use wind::check_velocity as check_wind_velocity;
pub use wind::{Region, Wind, WindLaw};
