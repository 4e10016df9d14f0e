//! Pure geometry: meshes, boxes, and which things come near each other. No physics, no files.

mod aabb;
mod bvh;
mod mesh;

pub use aabb::Aabb;
pub use bvh::{Bvh, Sweep};
pub use mesh::{Mesh, MeshError};

/// A point (m), a direction, or a velocity (m/s).
pub type Vector = nalgebra::Vector3<f64>;
