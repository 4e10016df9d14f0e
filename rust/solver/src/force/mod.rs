//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, force fields, pressure, water.

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
