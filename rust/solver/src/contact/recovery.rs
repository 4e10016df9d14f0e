//! How what has passed through comes free again.
//!
//! Where an edge with direction E passes through a triangle with normal N, the contour in which both surfaces cut each
//! other gets shorter if the edge moves, relative to the triangle, along
//!
//! ```text
//! G = sum_i ( R_i - 2 (E·R_i)/(E·N) N )
//! ```
//!
//! over the faces i of the edge, `R_i` the direction of the contour into face i. Each crossing pushes the edge and the
//! triangle apart along G, some way a step, as a contact. A contour that shrinks from its ends or closes in upon itself
//! vanishes in the end. Pairs of which both sides take part in a crossing are let go meanwhile; all others stay protected.
//!
//! A contour across two whole sheets does not get shorter wherever it goes. Two cloths therefore part along the normal of
//! the triangle, each to the side on which its middle lies: the contour then travels to the nearer end. So do surfaces that
//! lie in each other and have no contour. What lies inside a closed body leaves it as one ([`super::enclosure`]).
//!
//! Source: Volino & Magnenat-Thalmann 2006.

use boucle_geometry::Vector;
use boucle_geometry::distance::edge_edge;

use super::Contacts;
use super::bodies::Bodies;
use super::candidate::Candidate;
use super::contact::Contact;
use super::enclosure::Region;
use super::features::{Edge, NONE, Triangle};
use super::paths::Paths;
use crate::state::Coordinates;

/// How far apart a crossing is pushed in a step, as a part of its edge.
const OF_EDGE: f64 = 0.1;

/// Vectors of unit vectors' sums and products that are shorter have no direction.
const SMALL: f64 = 1e-6;

/// An edge through a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) edge: Edge,
    pub(super) triangle: Triangle,
}

/// What is tangled.
#[derive(Clone, Debug, Default)]
pub(super) struct Tangle {
    pub(super) crossings: Vec<Crossing>,
    regions: Vec<Region>,
    /// Which points take part in a crossing, or lie in a body, or are of a body that holds such; empty if none are.
    is_tangled: Vec<bool>,
}

impl Tangle {
    fn of(crossings: Vec<Crossing>, regions: Vec<Region>, body_of: &[u32]) -> Self {
        if crossings.is_empty() {
            return Self::default();
        }
        let holds = |body: u32| regions.iter().any(|region| region.body == body);
        let mut is_tangled: Vec<bool> = body_of.iter().map(|&body| holds(body)).collect();
        for vertex in regions.iter().flat_map(|region| &region.vertices) {
            is_tangled[*vertex as usize] = true;
        }
        for Crossing { edge, triangle } in &crossings {
            for &point in edge.points.iter().chain(&triangle.points) {
                is_tangled[point as usize] = true;
            }
        }
        Self { crossings, regions, is_tangled }
    }

    /// Whether a candidate is let go.
    #[inline]
    pub(super) fn lets_go(&self, candidate: &Candidate) -> bool {
        if self.is_tangled.is_empty() {
            return false;
        }
        let (first, second) = candidate.points.split_at(candidate.split());
        let is_tangled = |&point: &u32| self.is_tangled[point as usize];
        first.iter().any(is_tangled) && second.iter().any(is_tangled)
    }
}

impl Contacts {
    /// Finds what is tangled as a step starts, if anything was before.
    pub(super) fn follow_tangle(&mut self, positions: &Coordinates) {
        if !self.tangle.crossings.is_empty() {
            self.stand_still(positions);
            self.tangle = self.find_tangle();
        }
    }

    /// What is tangled where points start.
    pub(super) fn find_tangle(&self) -> Tangle {
        let crossings = self.crossings();
        let regions = self.regions(&crossings);
        Tangle::of(crossings, regions, &self.bodies.body_of)
    }

    /// What pushes tangled features apart.
    pub(super) fn parting(&self) -> Vec<Contact> {
        let Self { bodies, paths, tangle, .. } = self;
        if tangle.crossings.is_empty() {
            return Vec::new();
        }
        let middles = middles(bodies, paths);
        let mut is_inside = vec![false; bodies.particle_count];
        for vertex in tangle.regions.iter().flat_map(|region| &region.vertices) {
            is_inside[*vertex as usize] = true;
        }
        let takes_part = |&point: &u32| bodies.is_particle(point) && is_inside[point as usize];
        // What a region takes along needs no push of its own.
        let free = tangle.crossings.iter().filter(|crossing| {
            !crossing.edge.points.iter().chain(&crossing.triangle.points).any(takes_part)
        });
        let parted = free.flat_map(|crossing| {
            let owners = [crossing.edge.points[0], crossing.triangle.points[0]]
                .map(|point| bodies.body_of[point as usize] as usize);
            part(crossing, middles[owners[0]] - middles[owners[1]], bodies, paths)
        });
        let out = tangle.regions.iter().flat_map(|region| {
            let owners = [region.vertices[0], region.anchor].map(|point| bodies.body(point));
            region.parting(owners.iter().map(|owner| owner.thickness).sum())
        });
        parted.chain(out).collect()
    }
}

/// The middle of each body's points (m).
fn middles(bodies: &Bodies, paths: &Paths) -> Vec<Vector> {
    let mut sums = vec![(Vector::zeros(), 0.0); bodies.each.len()];
    for (start, &body) in paths.start.iter().zip(&bodies.body_of) {
        let (sum, count) = &mut sums[body as usize];
        *sum += start;
        *count += 1.0;
    }
    sums.into_iter().map(|(sum, count)| sum / count).collect()
}

/// The contacts that push the ends of an edge away from a triangle, whose bodies lie so (m) to each other.
fn part(
    crossing: &Crossing,
    apart: Vector,
    bodies: &Bodies,
    paths: &Paths,
) -> impl Iterator<Item = Contact> {
    let Crossing { edge, triangle } = *crossing;
    let place = |point: u32| paths.start[point as usize];
    let [a, b, c] = triangle.points.map(place);
    let [p, q] = edge.points.map(place);
    let are_cloths = bodies.is_particle(edge.points[0]) && bodies.is_particle(triangle.points[0]);
    let is_same =
        bodies.body_of[edge.points[0] as usize] == bodies.body_of[triangle.points[0] as usize];
    let shortening = if are_cloths && !is_same { None } else { shortening(crossing, place) };
    let direction = shortening.unwrap_or_else(|| {
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector::z);
        let side = normal.dot(&apart);
        let is_ahead = side > 0.0 || (side == 0.0 && edge.points[0] > triangle.points[0]);
        if is_ahead { normal } else { -normal }
    });
    // Where they cross, roughly: the weights need not be exact.
    let middle = edge_edge(&p, &q, &a, &((b + c) * 0.5));
    let [from_a, to_middle] = [-middle.weights[2], -middle.weights[3]];
    let weights = [1.0, -from_a, -0.5 * to_middle, -0.5 * to_middle];
    let thickness: f64 = [edge.points[0], triangle.points[0]]
        .iter()
        .map(|&point| bodies.body(point).thickness)
        .sum();
    let way = (0.5 * thickness).max(OF_EDGE * (q - p).norm());
    edge.points.into_iter().map(move |end| {
        let [a, b, c] = triangle.points;
        Contact::parting([end, a, b, c], weights, direction, way)
    })
}

/// The direction in which an edge moves away from a triangle so that their contour gets shorter.
fn shortening(crossing: &Crossing, place: impl Fn(u32) -> Vector) -> Option<Vector> {
    let Crossing { edge, triangle } = crossing;
    let [a, b, c] = triangle.points.map(&place);
    let [p, q] = edge.points.map(&place);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let along = (q - p).try_normalize(0.0)?;
    let slope = along.dot(&normal);
    let mut sum = Vector::zeros();
    for apex in edge.apexes.into_iter().filter(|&apex| apex != NONE) {
        let across = place(apex) - p;
        let across = across - along * along.dot(&across);
        let face_normal = along.cross(&across).try_normalize(0.0)?;
        let line = face_normal.cross(&normal).try_normalize(SMALL)?;
        let line = if line.dot(&across) < 0.0 { -line } else { line };
        let slope = if slope.abs() < SMALL { SMALL.copysign(slope) } else { slope };
        sum += line - normal * (2.0 * along.dot(&line) / slope);
    }
    sum.try_normalize(SMALL)
}
