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
//! lie in each other and have no contour.
//!
//! Source: Volino & Magnenat-Thalmann 2006.

use boucle_geometry::Vector;
use boucle_geometry::distance::edge_edge;

use super::Contacts;
use super::bodies::Bodies;
use super::candidate::Candidate;
use super::contact::Contact;
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
    /// Which points take part in a crossing; empty if none does.
    is_tangled: Vec<bool>,
}

impl Tangle {
    pub(super) fn of(crossings: Vec<Crossing>, point_count: usize) -> Self {
        if crossings.is_empty() {
            return Self::default();
        }
        let mut is_tangled = vec![false; point_count];
        for Crossing { edge, triangle } in &crossings {
            for &point in edge.points.iter().chain(&triangle.points) {
                is_tangled[point as usize] = true;
            }
        }
        Self { crossings, is_tangled }
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
            self.tangle = Tangle::of(self.crossings(), self.bodies.rest.len());
        }
    }

    /// What pushes tangled features apart.
    pub(super) fn parting(&self) -> Vec<Contact> {
        let Self { bodies, paths, tangle, .. } = self;
        if tangle.crossings.is_empty() {
            return Vec::new();
        }
        let middles = middles(bodies, paths);
        let parted = tangle.crossings.iter().flat_map(|crossing| {
            let owners = [crossing.edge.points[0], crossing.triangle.points[0]]
                .map(|point| bodies.body_of[point as usize] as usize);
            part(crossing, middles[owners[0]] - middles[owners[1]], bodies, paths)
        });
        parted.collect()
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
