//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, force fields, pressure.

mod air;
mod field;
mod fields;
mod filling;
mod pressure;
mod wind;

pub(crate) use air::{Air, AirScratch};
pub(crate) use field::NUMBERS as FIELD_NUMBERS;
pub use field::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
pub(crate) use filling::Level;
pub use pressure::Pressure;
pub(crate) use pressure::{PressureScratch, Pressures};
pub(crate) use wind::check_velocity as check_wind_velocity;
pub use wind::{Region, Wind, WindLaw};
