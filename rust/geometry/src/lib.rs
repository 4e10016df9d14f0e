//! Pure geometry: meshes and boxes. No physics, no files.

mod aabb;
mod mesh;

pub use aabb::Aabb;
pub use mesh::{Mesh, MeshError};

/// A point (m), a direction, or a velocity (m/s).
pub type Vector = nalgebra::Vector3<f64>;
