//! Regions of cloth inside closed bodies of triangles.
//!
//! Where a sheet is stuck in a body all around, their contour gets shorter in no direction: its sides pull against each
//! other. But of a closed body it is known what lies inside. The surface parts the vertices of a cloth by the edges that cross
//! it, and each region inside moves out as one:
//!
//! - along the body's normals where the region has come in, if these agree: it is not deep inside;
//! - else along the cloth's own normal, to the side on which the shorter way leads out of the whole body.

use boucle_geometry::{Mesh, Vector};

use super::Contacts;
use super::contact::Contact;
use super::recovery::Crossing;
use crate::grouped::Grouped;

/// Unit vectors agree if their mean is at least so long.
const AGREEING: f64 = 0.7;

/// Vertices of a cloth inside a body.
#[derive(Clone, Debug)]
pub(super) struct Region {
    pub(super) body: u32,
    pub(super) vertices: Vec<u32>,
    /// The way out, of unit length.
    out: Vector,
    /// A point of the body.
    pub(super) anchor: u32,
}

impl Region {
    /// What pushes it out, some way (m) a step.
    pub(super) fn parting(&self, way: f64) -> impl Iterator<Item = Contact> {
        let Self { out, anchor, .. } = *self;
        self.vertices.iter().map(move |&vertex| {
            let points = [vertex, anchor, anchor, anchor];
            Contact::parting(points, [1.0, -1.0, 0.0, 0.0], out, way)
        })
    }
}

/// 1 if the faces of a closed mesh are seen from outside, -1 if from inside, 0 if it is not closed.
pub(crate) fn facing(mesh: &Mesh, positions: &[Vector]) -> f64 {
    let mut sides: Vec<([u32; 2], i32)> = mesh
        .faces()
        .flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners
                .iter()
                .zip(next)
                .map(|(&a, &b)| ([a.min(b), a.max(b)], if a < b { 1 } else { -1 }))
        })
        .collect();
    sides.sort_unstable();
    let is_closed = sides
        .chunk_by(|(one, _), (other, _)| one == other)
        .all(|same| same.len() == 2 && same[0].1 + same[1].1 == 0);
    if !is_closed {
        return 0.0;
    }
    let volume: f64 = (0..mesh.face_count())
        .map(|face| mesh.vector_area(face, positions).dot(&positions[mesh.face(face)[0] as usize]))
        .sum();
    volume.signum()
}

/// How the vertices of cloths lie to one body.
struct Sides {
    /// By particle: 1 for those inside, -1 for those outside, 0 for those of which nothing is known.
    of: Vec<i8>,
    /// Edges of cloths that cross the body's surface, sorted.
    crossed: Vec<[u32; 2]>,
}

impl Contacts {
    /// The regions of cloths inside closed bodies, by what crosses their surfaces.
    pub(super) fn regions(&self, crossings: &[Crossing]) -> Vec<Region> {
        let Self { bodies, .. } = self;
        let mut bodies_met: Vec<u32> = crossings
            .iter()
            .filter(|crossing| bodies.is_particle(crossing.edge.points[0]))
            .map(|crossing| bodies.body_of[crossing.triangle.points[0] as usize])
            .filter(|&body| bodies.each[body as usize].facing != 0.0)
            .collect();
        bodies_met.sort_unstable();
        bodies_met.dedup();
        if bodies_met.is_empty() {
            return Vec::new();
        }
        let neighbors = self.neighbors();
        bodies_met
            .into_iter()
            .flat_map(|body| self.regions_in(body, crossings, &neighbors))
            .collect()
    }

    /// The vertices that edges of cloths join to each.
    fn neighbors(&self) -> Grouped<u32> {
        let edges = self.bodies.cloths.edges.iter().map(|edge| edge.points);
        Grouped::new(self.bodies.particle_count, edges.flat_map(|[a, b]| [(a, b), (b, a)]))
    }

    fn regions_in(
        &self,
        body: u32,
        crossings: &[Crossing],
        neighbors: &Grouped<u32>,
    ) -> Vec<Region> {
        let meets = |crossing: &&Crossing| {
            self.bodies.is_particle(crossing.edge.points[0])
                && self.bodies.body_of[crossing.triangle.points[0] as usize] == body
        };
        let own: Vec<&Crossing> = crossings.iter().filter(meets).collect();
        let sides = self.sides(&own);
        let seeds: Vec<u32> =
            (0..sides.of.len() as u32).filter(|&point| sides.of[point as usize] > 0).collect();
        let mut is_taken = vec![false; sides.of.len()];
        let mut regions = Vec::new();
        for seed in seeds {
            if is_taken[seed as usize] {
                continue;
            }
            if let Some(vertices) = flood(seed, &sides, neighbors, &mut is_taken) {
                regions.push(self.region(body, vertices, &own));
            }
        }
        regions
    }

    /// On which sides of a body's surface the ends of edges that cross it once are.
    fn sides(&self, own: &[&Crossing]) -> Sides {
        let mut crossed: Vec<[u32; 2]> = own.iter().map(|crossing| crossing.edge.points).collect();
        crossed.sort_unstable();
        let mut of = vec![0; self.bodies.particle_count];
        for crossing in own {
            let ends = crossing.edge.points;
            let first = crossed.partition_point(|edge| *edge < ends);
            if crossed.get(first + 1) == Some(&ends) {
                continue;
            }
            let [p, q] = ends.map(|end| self.paths.start[end as usize]);
            let enters = self.outward(crossing).dot(&(q - p)) < 0.0;
            let [inside, outside] = if enters { [ends[1], ends[0]] } else { ends };
            of[inside as usize] = 1;
            of[outside as usize] = -1;
        }
        crossed.dedup();
        Sides { of, crossed }
    }

    /// The normal of a crossing's triangle, of unit length, out of its closed body.
    fn outward(&self, crossing: &Crossing) -> Vector {
        let points = crossing.triangle.points;
        let [a, b, c] = points.map(|point| self.paths.start[point as usize]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector::zeros);
        self.bodies.body(points[0]).facing * normal
    }

    /// A region and its way out.
    fn region(&self, body: u32, vertices: Vec<u32>, own: &[&Crossing]) -> Region {
        let mut is_in = vec![false; self.bodies.particle_count];
        for &vertex in &vertices {
            is_in[vertex as usize] = true;
        }
        let takes_part = |points: &[u32]| points.iter().any(|&point| is_in[point as usize]);
        let (mut sum, mut count) = (Vector::zeros(), 0.0);
        for crossing in own.iter().filter(|crossing| takes_part(&crossing.edge.points)) {
            sum += self.outward(crossing);
            count += 1.0;
        }
        let place = |point: u32| self.paths.start[point as usize];
        let area: Vector = self
            .bodies
            .cloths
            .triangles
            .iter()
            .filter(|triangle| takes_part(&triangle.points))
            .map(|triangle| {
                let [a, b, c] = triangle.points.map(place);
                (b - a).cross(&(c - a))
            })
            .sum();
        let out = match area.try_normalize(0.0) {
            Some(normal) if sum.norm() < AGREEING * count => {
                let way_out = |out: &Vector| self.way_out(body, &vertices, out);
                if way_out(&normal) <= way_out(&-normal) { normal } else { -normal }
            }
            _ => sum.try_normalize(0.0).unwrap_or_else(Vector::z),
        };
        let anchor = self.bodies.body_of.partition_point(|&owner| owner < body) as u32;
        Region { body, vertices, out, anchor }
    }

    /// How far (m) vertices must go in a direction until the whole body is behind them.
    fn way_out(&self, body: u32, vertices: &[u32], out: &Vector) -> f64 {
        let points = self.bodies.body_of.iter().zip(&self.paths.start);
        let of_body = points.filter(|&(&owner, _)| owner == body).map(|(_, place)| place.dot(out));
        let farthest = of_body.fold(f64::NEG_INFINITY, f64::max);
        let places = vertices.iter().map(|&vertex| self.paths.start[vertex as usize].dot(out));
        farthest - places.fold(f64::INFINITY, f64::min)
    }
}

/// The vertices that are inside with a seed; nothing if one of them is outside, too.
fn flood(
    seed: u32,
    sides: &Sides,
    neighbors: &Grouped<u32>,
    is_taken: &mut [bool],
) -> Option<Vec<u32>> {
    let (mut found, mut done, mut is_sound) = (vec![seed], 0, true);
    is_taken[seed as usize] = true;
    while done < found.len() {
        let vertex = found[done];
        done += 1;
        for &next in neighbors.of(vertex as usize) {
            let edge = [vertex.min(next), vertex.max(next)];
            if is_taken[next as usize] || sides.crossed.binary_search(&edge).is_ok() {
                continue;
            }
            is_sound &= sides.of[next as usize] >= 0;
            is_taken[next as usize] = true;
            found.push(next);
        }
    }
    is_sound.then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{Cloth, Mass};
    use crate::collider::{Collider, Shape};
    use crate::collision::Collision;
    use crate::interrupter::Interrupter;
    use crate::material::SpringMaterial;
    use crate::state::State;

    /// The corners of a box of 0.6 x 0.6 m, 0.4 m high below z = `top`.
    fn corners(top: f64) -> Vec<Vector> {
        let corner = |i: usize| {
            let end = |axis: usize| if i >> axis & 1 == 1 { 0.5 } else { -0.5 };
            Vector::new(0.6 * end(0), 0.6 * end(1), top - 0.2 + 0.4 * end(2))
        };
        (0..8).map(corner).collect()
    }

    /// The regions of a sheet of 21 x 21 vertices, 2 m wide, in z = 0.
    fn regions(shape: Shape, positions: Vec<Vector>) -> Vec<Region> {
        let place = |i: u32| 0.1 * f64::from(i) - 1.0 + 0.013;
        let sheet = (0..441).map(|i| Vector::new(place(i % 21), place(i / 21), 0.0)).collect();
        let quads: Vec<[u32; 4]> =
            (0..400).map(|i| i / 20 * 21 + i % 20).map(|a| [a, a + 1, a + 22, a + 21]).collect();
        let mesh = Mesh::from_faces(441, &quads).expect("a grid");
        let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
        let cloth = Cloth::from_mesh("sheet", mesh, sheet, &mass, material, Vec::new());
        let cloth =
            Cloth { collision: Some(Collision::default()), ..cloth.expect("a sheet of cloth") };
        let name = "body".to_owned();
        let body = Collider { name, shape, positions, thickness: 0.0, friction: 0.3 };
        let state = State::at_rest(&cloth.positions);
        let mut contacts = Contacts::new(&[cloth], &[body], &Interrupter::default());
        assert!(contacts.intersections(&state.position) > 0);
        let crossings = contacts.crossings();
        contacts.regions(&crossings)
    }

    #[test]
    fn a_closed_mesh_is_seen_from_outside_or_from_inside() {
        let Shape::Mesh(mesh) = Shape::cuboid() else { panic!("a box is a mesh") };
        let far: Vec<Vector> = corners(0.0).iter().map(|x| x + Vector::repeat(5.0)).collect();
        assert!((facing(&mesh, &far) - 1.0).abs() < 0.1);
        let mirrored: Vec<Vector> = far.iter().map(|x| Vector::new(-x.x, x.y, x.z)).collect();
        assert!((facing(&mesh, &mirrored) + 1.0).abs() < 0.1);
        let open: Vec<&[u32]> = mesh.faces().skip(1).collect();
        let open = Mesh::from_faces(8, &open).expect("a box without a side");
        assert!(facing(&open, &far).abs() < 0.1);
    }

    /// To the nearer of its two ends, whichever way its faces look.
    #[test]
    fn a_sheet_with_a_box_through_its_middle_leaves_it_along_its_own_normal() {
        for (top, up) in [(0.1, 1.0), (0.3, -1.0)] {
            for turn in [1.0, -1.0] {
                let mut positions = corners(top);
                for x in &mut positions {
                    x.x *= turn;
                }
                let found = regions(Shape::cuboid(), positions);
                assert_eq!(found.len(), 1);
                assert_eq!(found[0].vertices.len(), 36);
                assert!((found[0].out - up * Vector::z()).norm() < 1e-12, "{:?}", found[0].out);
            }
        }
    }

    #[test]
    fn a_sheet_whose_side_is_a_little_inside_a_box_leaves_it_by_the_way_it_came() {
        let positions = corners(0.1).iter().map(|x| x + 1.25 * Vector::x()).collect();
        let found = regions(Shape::cuboid(), positions);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].vertices.len(), 6);
        assert!(found[0].out.x < -0.7, "{:?}", found[0].out);
    }

    #[test]
    fn an_open_body_holds_nothing() {
        let Shape::Mesh(mesh) = Shape::cuboid() else { panic!("a box is a mesh") };
        let open: Vec<&[u32]> = mesh.faces().skip(1).collect();
        let open = Mesh::from_faces(8, &open).expect("a box without a side");
        assert!(regions(Shape::Mesh(open), corners(0.1)).is_empty());
    }
}
