//! The triangles and hinges of a cloth of fabric, from its mesh at rest.

use boucle_geometry::{Mesh, Vector};

use super::compliance::Face;
use super::hinge;
use super::material::{Fabric, Warp};
use super::membrane::Triangle;
use super::packs;
use crate::cloth::Cloth;
use crate::law::Spring;
use crate::material::SpringKind;

/// How much of a direction must lie in a face to be its warp; else another one is.
const ALONG: f64 = 0.1;

/// An edge between two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hinge {
    /// The edge, then the wings: see [`hinge`].
    pub(super) corners: [u32; 4],
    /// rad, without creases.
    pub(super) rest_angle: f64,
    /// What the heights of its corners count for in its angle (1/m).
    pub(super) weights: [f64; 4],
    pub(super) law: u32,
}

/// Triangles, faces as hinges see them, in the same order, and hinges.
#[derive(Clone, Debug, Default)]
pub(super) struct Elements {
    pub(super) triangles: Vec<Triangle>,
    pub(super) faces: Vec<Face>,
    /// Of each triangle, the springs of its cloth from each corner to the next.
    pub(super) sides: Vec<[u32; 3]>,
    pub(super) hinges: Vec<Hinge>,
}

impl Elements {
    /// Adds those of a cloth whose vertices are numbered from `base`.
    pub(super) fn add(&mut self, cloth: &Cloth, fabric: &Fabric, base: u32, law: u32) {
        let (mesh, positions) = (&cloth.mesh, cloth.rest());
        let first = self.triangles.len();
        let mut sides = Vec::new();
        let mut springs: Vec<([u32; 2], u32)> =
            (0..).zip(&cloth.springs).map(|(number, spring)| (spring.ends, number)).collect();
        springs.sort_unstable();
        let spring_of = |pair: [u32; 2]| {
            let place = springs.partition_point(|(ends, _)| *ends < pair);
            springs[place].1
        };
        let triangles: Vec<_> = mapped_triangles(mesh, &fabric.warp).collect();
        let corners: Vec<[u32; 3]> = triangles.iter().map(|(corners, _)| *corners).collect();
        let order = packs::order(&corners);
        for (place, &number) in order.iter().enumerate() {
            let (corners, map) = triangles[number as usize];
            let number = (first + place) as u32;
            let at = corners.map(|corner| positions[corner as usize]);
            let flat = flattened(at, warp_of(at, &fabric.warp, map));
            self.triangles.push(Triangle::new(corners.map(|corner| base + corner), flat, law));
            let bend = fabric.holding_bend();
            self.faces.push(Face { flat, hinges: [None; 3], signs: [1.0; 3], bend });
            let pairs = [0, 1, 2].map(|i| {
                let [a, b] = [corners[i], corners[(i + 1) % 3]];
                [a.min(b), a.max(b)]
            });
            sides.extend((0..3).zip(pairs).map(|(i, pair)| (pair, number, i)));
            self.sides.push(pairs.map(spring_of));
        }
        sides.sort_unstable();
        let mut hinges = Vec::new();
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            // An edge of three faces or more has no angle: it is free to fold.
            let [(_, mut one, mut i), (_, mut other, mut j)] = *same else { continue };
            let given = |number: u32| order[number as usize - first];
            let own = |number: u32| self.triangles[number as usize].corners;
            let is_wound_alike = own(one)[i] != own(other)[j];
            if !is_wound_alike {
                // The first face of the mesh says which way is up, however many pieces it is in.
                if given(one) > given(other) {
                    ((one, i), (other, j)) = ((other, j), (one, i));
                }
                self.faces[other as usize].signs[j] = -1.0;
            }
            let [a, b, left] = [0, 1, 2].map(|k| own(one)[(i + k) % 3]);
            hinges.push(([a, b, left, own(other)[(j + 2) % 3]], [(one, i), (other, j)]));
        }
        let corners: Vec<[u32; 4]> = hinges.iter().map(|(corners, _)| *corners).collect();
        for number in packs::order(&corners) {
            let (corners, faces) = hinges[number as usize];
            for (face, side) in faces {
                self.faces[face as usize].hinges[side] = Some(self.hinges.len() as u32);
            }
            let at = corners.map(|corner| positions[(corner - base) as usize]);
            let (rest_angle, weights) = (hinge::angle(at), hinge::weights(at));
            self.hinges.push(Hinge { corners, rest_angle, weights, law });
        }
    }
}

/// The edges of a fabric's mesh and of the triangles that its faces fall into, as springs without stiffness: their lengths
/// are what strain is measured by, and what is limited.
pub(crate) fn edges(mesh: &Mesh, positions: &[Vector]) -> Vec<Spring> {
    let of_faces = mesh.edges();
    let mut diagonals: Vec<[u32; 2]> = mesh
        .triangles()
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .filter(|pair| of_faces.binary_search(pair).is_err())
        .collect();
    diagonals.sort_unstable();
    diagonals.dedup();
    let kinds = [(SpringKind::Stretch, of_faces), (SpringKind::Shear, diagonals)];
    let springs = kinds.into_iter().flat_map(|(kind, pairs)| {
        pairs.into_iter().map(move |ends| {
            let [a, b] = ends.map(|end| positions[end as usize]);
            let rest_length = (a - b).norm();
            Spring { ends, kind, rest_length, stiffness: 0.0, damping: 0.0 }
        })
    });
    springs.collect()
}

/// The triangles that faces fall into, with their places in the map.
fn mapped_triangles<'a>(
    mesh: &'a Mesh,
    warp: &'a Warp,
) -> impl Iterator<Item = ([u32; 3], Option<[[f64; 2]; 3]>)> + 'a {
    let starts = mesh.faces().scan(0, |start, face| {
        let own = *start;
        *start += face.len();
        Some(own)
    });
    mesh.faces().zip(starts).flat_map(move |(face, start)| {
        (1..face.len() - 1).map(move |i| {
            let places = [0, i, i + 1];
            let map = match warp {
                Warp::Along(_) => None,
                Warp::Mapped(map) => Some(places.map(|place| map[start + place])),
            };
            (places.map(|place| face[place]), map)
        })
    })
}

/// The direction of the warp in the plane of a triangle, of length 1.
fn warp_of(at: [Vector; 3], warp: &Warp, map: Option<[[f64; 2]; 3]>) -> Vector {
    let normal = (at[1] - at[0]).cross(&(at[2] - at[0])).normalize();
    let within = |direction: Vector| direction - direction.dot(&normal) * normal;
    let wished = match (warp, map) {
        (Warp::Mapped(_), Some([a, b, c])) => {
            let [[u1, v1], [u2, v2]] = [b, c].map(|uv| [uv[0] - a[0], uv[1] - a[1]]);
            // Where v grows and u does not: the second column of the inverse map, but for its length.
            let turned = if u1 * v2 - u2 * v1 < 0.0 { -1.0 } else { 1.0 };
            turned * (u1 * (at[2] - at[0]) - u2 * (at[1] - at[0]))
        }
        (Warp::Along(direction), _) => within(*direction),
        (Warp::Mapped(_), None) => Vector::zeros(),
    };
    let scale = match warp {
        Warp::Along(direction) => direction.norm(),
        Warp::Mapped(_) => 0.0,
    };
    let axes = [Vector::y(), Vector::z(), Vector::x()];
    let others = axes.into_iter().map(within).find(|way| way.norm() > ALONG);
    let is_clear = wished.norm() > ALONG * scale;
    let way = if is_clear { Some(wished) } else { others };
    way.and_then(|way| way.try_normalize(0.0)).unwrap_or_else(|| (at[1] - at[0]).normalize())
}

/// A triangle (m) in coordinates of warp and weft, from its first corner.
fn flattened(at: [Vector; 3], warp: Vector) -> [[f64; 2]; 3] {
    let normal = (at[1] - at[0]).cross(&(at[2] - at[0])).normalize();
    // Warp x weft = normal: the flat triangle turns as the face does.
    let weft = normal.cross(&warp);
    at.map(|point| [(point - at[0]).dot(&warp), (point - at[0]).dot(&weft)])
}
