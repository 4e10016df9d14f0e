//! Water on the outside of a closed cloth: the pressure of its depth, which carries it.
//!
//! At a depth h > 0 water presses with rho g h against the outside, nothing presses from within. A triangle of area A and outward
//! normal n, whose depth goes evenly from corner to corner, is cut where it leaves the water:
//!
//! ```text
//! F_i = -n rho g  integral of max(0, h) l_i dA           (N)    l_i: the barycentric coordinate of corner i
//! U   = -1/2 rho g sum of n_z  integral of max(0, h)² dA (J)
//! ```
//!
//! Under a calm surface all together are the weight of the water that the body displaces, upwards, and U is the work to push
//! that aside. In the matrix stands `rho g A |n_z|/3` of the part in water at each corner: a bound, for water pushes the upper faces down
//! the more the deeper they are. What turning faces add is left out, as for gas ([`super::pressure`]).
//!
//! Source: Archimedes; the integrals are those of quadratic polynomials on triangles.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::fields::Pushed;
use crate::grouped::Grouped;
use crate::kernel::CHUNK;
use crate::state::State;

/// A closed cloth in the simulation's numbering.
#[derive(Debug)]
pub(super) struct Hull {
    pub(super) first: usize,
    triangles: Vec<[u32; 3]>,
    /// For each of its particles, the corners of triangles that it is.
    corners_of: Grouped<u32>,
    /// 1 if its faces are seen from outside, else -1.
    facing: f64,
}

/// Force (N) and stiffness (N/m) at a corner of a triangle.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    force: Vector,
    stiffness: f64,
}

/// What water does to the corners of a hull.
#[derive(Debug, Default)]
pub(super) struct HullScratch(Vec<Corner>);

impl Hull {
    pub(super) fn new(
        first: usize,
        count: usize,
        triangles: impl Iterator<Item = [u32; 3]>,
        facing: f64,
    ) -> Self {
        let triangles: Vec<[u32; 3]> = triangles.collect();
        let corners = triangles.as_flattened().iter().zip(0..);
        let corners_of = Grouped::new(count, corners.map(|(&vertex, corner)| (vertex, corner)));
        let base = first as u32;
        let triangles = triangles.iter().map(|corners| corners.map(|corner| corner + base));
        Self { first, triangles: triangles.collect(), corners_of, facing }
    }

    /// Looks at every triangle, in water of a weight rho g (N/m³) and of that depth (m) at particles.
    pub(super) fn observe(
        &self,
        state: &State,
        weight: f64,
        depths: &[f64],
        scratch: &mut HullScratch,
    ) {
        scratch.0.resize(3 * self.triangles.len(), Corner::default());
        let corners = scratch.0.par_chunks_mut(3).zip(&self.triangles);
        corners.with_min_len(CHUNK / 8).for_each(|(out, triangle)| {
            let area = self.area(triangle, state);
            let wet = Wet::of(triangle.map(|corner| depths[corner as usize]));
            for (corner, out) in out.iter_mut().enumerate() {
                out.force = -weight * wet.by_corner[corner] * area;
                out.stiffness = weight * wet.part * area.z.abs() / 3.0;
            }
        });
    }

    /// Adds what water does to its particles.
    pub(super) fn push(&self, particle: usize, scratch: &HullScratch, out: &mut Pushed) {
        for &corner in self.corners_of.of(particle - self.first) {
            let Corner { force, stiffness } = scratch.0[corner as usize];
            out.force += force;
            out.stiffness += stiffness;
        }
    }

    /// The work (J) to push aside the water that it displaces.
    pub(super) fn energy(&self, state: &State, weight: f64, depths: &[f64]) -> f64 {
        let each = self.triangles.iter().map(|triangle| {
            let wet = Wet::of(triangle.map(|corner| depths[corner as usize]));
            wet.squares * self.area(triangle, state).z
        });
        -0.5 * weight * each.sum::<f64>()
    }

    /// The vector area (m²) of a triangle, outwards.
    fn area(&self, triangle: &[u32; 3], state: &State) -> Vector {
        let [a, b, c] = triangle.map(|corner| state.position.get(corner as usize));
        0.5 * self.facing * (b - a).cross(&(c - a))
    }
}

/// Integrals over the part of a triangle that is in water, in parts of its whole area.
#[derive(Debug, Default)]
struct Wet {
    /// Of 1.
    part: f64,
    /// Of `h l_i` (m).
    by_corner: [f64; 3],
    /// Of h² (m²).
    squares: f64,
}

impl Wet {
    /// For the depths (m) of the corners.
    fn of(depths: [f64; 3]) -> Self {
        let mut wet = Self::default();
        let (mut corners, mut count) = ([Vector::zeros(); 4], 0);
        for i in 0..3 {
            let j = (i + 1) % 3;
            let [here, next] = [depths[i], depths[j]];
            if here > 0.0 {
                corners[count] = Vector::ith(i, 1.0);
                count += 1;
            }
            if (here > 0.0) != (next > 0.0) {
                let part = here / (here - next);
                corners[count] = Vector::ith(i, 1.0 - part) + Vector::ith(j, part);
                count += 1;
            }
        }
        for last in 2..count {
            wet.add([corners[0], corners[last - 1], corners[last]], depths);
        }
        wet
    }

    /// Adds a triangle of such barycentric coordinates.
    fn add(&mut self, corners: [Vector; 3], depths: [f64; 3]) {
        let [a, b, c] = &corners;
        let part = a.dot(&b.cross(c)).abs();
        let depths = corners.map(|corner| corner.dot(&Vector::from(depths)));
        let sum: f64 = depths.iter().sum();
        self.part += part;
        self.squares += part / 12.0 * (depths.iter().map(|h| h * h).sum::<f64>() + sum * sum);
        for (i, by_corner) in self.by_corner.iter_mut().enumerate() {
            let own: f64 = corners.iter().map(|corner| corner[i]).sum();
            let both: f64 = corners.iter().zip(&depths).map(|(corner, h)| corner[i] * h).sum();
            *by_corner += part / 12.0 * (own * sum + both);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collider::Shape;
    use crate::scatter::scattered;

    const WEIGHT: f64 = 9810.0;

    /// A box that is turned and bent, in water up to a height.
    fn body() -> (Hull, State) {
        let Shape::Mesh(mesh) = Shape::cuboid() else { panic!("a box is a mesh") };
        let places: Vec<Vector> = (0..8_u32)
            .map(|i| {
                let corner = Vector::from_fn(|axis, _| f64::from(i >> axis & 1) - 0.5);
                let turned = nalgebra::Rotation3::new(Vector::new(0.4, -0.2, 0.9)) * corner;
                turned + Vector::from_fn(|axis, _| 0.1 * scattered(u64::from(i) * 3 + axis as u64))
            })
            .collect();
        (Hull::new(0, 8, mesh.triangles(), 1.0), State::at_rest(&places))
    }

    fn depths(state: &State, level: f64) -> Vec<f64> {
        (0..8).map(|particle| level - state.position.get(particle).z).collect()
    }

    fn forces(hull: &Hull, state: &State, level: f64) -> Vec<Pushed> {
        let mut scratch = HullScratch::default();
        hull.observe(state, WEIGHT, &depths(state, level), &mut scratch);
        let mut pushed = vec![Pushed::default(); 8];
        for (particle, pushed) in pushed.iter_mut().enumerate() {
            hull.push(particle, &scratch, pushed);
        }
        pushed
    }

    #[test]
    fn the_pressure_of_water_is_the_slope_of_its_energy() {
        const STEP: f64 = 1e-5;
        let (hull, state) = body();
        for level in [-0.4, 0.0, 0.17, 2.0] {
            let energy = |particle: usize, axis: usize, step: f64| {
                let mut state = state.clone();
                state.position.0[axis][particle] += step;
                hull.energy(&state, WEIGHT, &depths(&state, level))
            };
            for (particle, pushed) in forces(&hull, &state, level).iter().enumerate() {
                for axis in 0..3 {
                    let [a, b] = [STEP, -STEP].map(|step| energy(particle, axis, step));
                    let slope = (b - a) / (2.0 * STEP);
                    let error = (slope - pushed.force[axis]).abs();
                    assert!(error < 1e-6 * WEIGHT, "{level}, {particle}: {slope} {pushed:?}");
                }
            }
        }
    }

    /// Wholly under water: the weight of its volume, whatever its shape, and no force along the surface.
    #[test]
    fn a_body_under_water_is_carried_by_the_weight_of_its_volume() {
        let (hull, state) = body();
        let triangles = hull.triangles.iter();
        let volume: f64 = triangles
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| state.position.get(corner as usize));
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum();
        for level in [1.5, 40.0] {
            let total: Vector =
                forces(&hull, &state, level).iter().map(|pushed| pushed.force).sum();
            let error = (total - Vector::z() * WEIGHT * volume).norm();
            assert!(error < 1e-9 * WEIGHT * level, "{total:?}, {volume}");
        }
        assert!(forces(&hull, &state, -1.5).iter().all(|pushed| pushed.force == Vector::zeros()));
    }

    /// By brute force: the middles of many small triangles.
    #[test]
    fn integrals_over_the_wet_part_are_those_of_many_small_pieces() {
        const SIDES: u32 = 400;
        for depths in [[0.3, -0.2, 0.1], [-0.1, -0.4, 0.5], [1.0, 0.5, 0.2], [0.3, 0.0, -0.1]] {
            let wet = Wet::of(depths);
            let (mut part, mut by_corner, mut squares) = (0.0, Vector::zeros(), 0.0);
            let size = 1.0 / f64::from(SIDES * SIDES);
            for row in 0..SIDES {
                for column in 0..=2 * row {
                    let third = f64::from(column % 2 + 1) / 3.0;
                    let across = f64::from(column / 2) + third;
                    let down =
                        f64::from(row) + 1.0 - if column % 2 == 0 { 1.0 / 3.0 } else { 2.0 / 3.0 };
                    let b = across / f64::from(SIDES);
                    let a = (f64::from(SIDES) - down) / f64::from(SIDES);
                    let place = Vector::new(a, b, 1.0 - a - b);
                    let depth = place.dot(&Vector::from(depths));
                    if depth > 0.0 {
                        part += size;
                        by_corner += size * depth * place;
                        squares += size * depth * depth;
                    }
                }
            }
            assert!((wet.part - part).abs() < 5e-3, "{depths:?}: {} {part}", wet.part);
            assert!((Vector::from(wet.by_corner) - by_corner).norm() < 1e-3, "{depths:?}");
            assert!((wet.squares - squares).abs() < 1e-3, "{depths:?}");
        }
    }
}
