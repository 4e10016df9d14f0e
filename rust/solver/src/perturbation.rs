//! The unevenness of real cloth, in the smallest: what lets a flat sheet buckle.

use boucle_geometry::Vector;

use crate::cloth::{Cloth, placed};
use crate::scatter::scattered;
use crate::state::State;

/// Moves free particles along their normals by a part of the mean edge, in no order that the eye could see: a sheet
/// that is perfectly flat in a perfectly symmetric scene would never buckle.
pub(crate) fn perturb(state: &mut State, cloths: &[Cloth], part: f64) {
    for (cloth, base) in placed(cloths) {
        let mut normals = vec![Vector::zeros(); cloth.positions.len()];
        for (face, corners) in cloth.mesh.faces().enumerate() {
            let area = cloth.mesh.vector_area(face, &cloth.positions);
            for &corner in corners {
                normals[corner as usize] += area;
            }
        }
        for &pin in &cloth.pins {
            normals[pin as usize] = Vector::zeros();
        }
        let lengths: f64 = cloth.springs.iter().map(|spring| spring.rest_length).sum();
        let height = part * lengths / cloth.springs.len().max(1) as f64;
        for (vertex, normal) in normals.iter().enumerate() {
            let direction = normal.try_normalize(0.0).unwrap_or_else(Vector::zeros);
            let particle = base as usize + vertex;
            let position = state.position.get(particle);
            let moved = position + height * scattered(vertex as u64) * direction;
            state.position.set(particle, &moved);
        }
    }
}
