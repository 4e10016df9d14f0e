//! Pure geometry: meshes, boxes, which things come near each other, distances, collisions, intersections. No physics, no
//! files.

mod aabb;
mod bvh;
mod ccd;
pub mod distance;
mod intersection;
mod mesh;
mod winding;

pub use aabb::Aabb;
pub use bvh::{Bvh, Sweep, Way};
pub use ccd::{edge_edge_impact, point_triangle_impact};
pub use intersection::{Meeting, edge_crosses_triangle, edge_meets_triangle};
pub use mesh::{Mesh, MeshError};
pub use winding::is_inside;

#[cfg(test)]
mod scatter;

/// A point (m), a direction, or a velocity (m/s).
pub type Vector = nalgebra::Vector3<f64>;
