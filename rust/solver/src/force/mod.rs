//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, force fields, pressure.

mod field;
mod fields;
mod pressure;
mod wind;

pub use field::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
pub use pressure::Pressure;
pub(crate) use pressure::{Level, PressureScratch, Pressures};
pub(crate) use wind::{Air, AirScratch};
pub use wind::{Region, Wind, WindLaw};
