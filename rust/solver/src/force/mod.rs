//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, force fields.

mod field;
mod fields;
mod wind;

pub use field::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
pub(crate) use wind::{Air, AirScratch};
pub use wind::{Region, Wind, WindLaw};
