//! Forces that are not springs: gravity and air damping (in [`crate::system`]), wind.

mod wind;

pub(crate) use wind::{Air, AirScratch};
pub use wind::{Region, Wind, WindLaw};
