//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, force fields, pressure.

mod air;
mod field;
mod fields;
mod pressure;
mod wind;

pub(crate) use air::{Air, AirScratch};
pub use field::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
pub use pressure::Pressure;
pub(crate) use pressure::{Level, PressureScratch, Pressures};
pub(crate) use wind::check_velocity as check_wind_velocity;
pub use wind::{Region, Wind, WindLaw};
