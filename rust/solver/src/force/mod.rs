//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind, pressure.

mod pressure;
mod wind;

pub use pressure::Pressure;
pub(crate) use pressure::{Level, PressureScratch, Pressures};
pub(crate) use wind::{Air, AirScratch};
pub use wind::{Region, Wind, WindLaw};
