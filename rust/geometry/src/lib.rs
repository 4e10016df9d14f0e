//! Pure geometry: meshes, boxes, which things come near each other, distances, collisions, intersections. No physics, no
//! files.
//!
//! In the order in which contact needs them: [`mesh`] joins vertices to faces; a [`bvh`] of boxes ([`aabb`]) finds what may come
//! near each other; [`distance`] says how near it is, and where; [`ccd`] until when it surely stays apart; [`intersection`]
//! whether it passes through, decided exactly; [`winding`] what is inside.
//!
//! Lengths in m, all f64; only the boxes of a hierarchy are f32, with room for their rounding.

#![allow(rustdoc::private_intra_doc_links, reason = "the lecture is built with private items")]

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
