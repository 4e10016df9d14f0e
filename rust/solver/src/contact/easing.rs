//! Pairs of a cloth that is thick for its edges.
//!
//! What lies near each other at rest keeps less between it than the thickness ([`super::contact`]): a part of its distance
//! at rest, which is not more than that between any two of its points. So, of a cloth that is as thick as its edges are
//! long, the sieve need not show everything with everything around it.

use boucle_geometry::Vector;

use super::bodies::Bodies;
use super::contact::OF_REST;

/// More than the part of the distance at rest that is kept: what rounding loses, but very far from the origin.
pub(super) const OF_REST_AT_MOST: f32 = OF_REST as f32 + 0.01;

/// How much less is enough.
#[derive(Debug)]
pub(super) struct Easing {
    /// Particles at rest (m), from the middle of all.
    places: Vec<[f32; 3]>,
    /// For each body, by how much less (m) a pair of it may come near than others, if it lay near at rest.
    by: Vec<f32>,
}

impl Easing {
    /// Of bodies that are thicker than their points may stray; nothing, if there are none.
    pub(super) fn of(bodies: &Bodies) -> Option<Self> {
        let less = bodies.each.iter().map(|body| {
            let more = if body.with_self { (body.thickness - body.slack).max(0.0) } else { 0.0 };
            2.0 * more as f32
        });
        let by: Vec<f32> = less.take(bodies.cloth_count()).collect();
        if by.iter().all(|&by| by == 0.0) {
            return None;
        }
        let points = &bodies.rest[..bodies.particle_count];
        let middle = points.iter().sum::<Vector>() / points.len() as f64;
        let places = points.iter().map(|point| (point - middle).map(|x| x as f32).into()).collect();
        Some(Self { places, by })
    }

    /// Where points of one body are at rest, and by how much less is enough for them; nothing of two bodies.
    #[inline(always)]
    pub(super) fn between(
        &self,
        bodies: &Bodies,
        points: [u32; 4],
    ) -> Option<([&[f32; 3]; 4], f32)> {
        let [one, .., other] = points.map(|point| bodies.body_of[point as usize]);
        let by = *self.by.get(one as usize)?;
        (one == other).then(|| (points.map(|point| &self.places[point as usize]), by))
    }
}
