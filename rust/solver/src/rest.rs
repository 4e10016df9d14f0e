//! Rest lengths that change, by shrink or as a rest shape that moves, and with the shape the rest angles of hinges.
//!
//! A spring between vertices i and j whose rest shape spans L (m) has the rest length
//!
//! ```text
//! L sqrt((1 - s_i) (1 - s_j))          (m)
//! ```
//!
//! with the shrink s at both. Over a frame rest lengths go evenly from what they were to what they are to be. Stiffness and
//! mass stay those of the cloth as it was given.
//!
//! Source: the geometric mean is Blender's.

use boucle_geometry::Vector;

use crate::cloth::Cloth;
use crate::fabric::Fabrics;
use crate::kernel::{Layout, Place};
use crate::material::SpringKind;
use crate::tailoring::CLOSED;

/// The rest lengths (m) of one cloth's springs, then the rest angles (rad) of its hinges.
#[derive(Debug)]
pub(crate) struct Rest {
    /// As the cloth was given.
    given: Vec<f64>,
    /// As the frame begins, and as it ends.
    from: Vec<f64>,
    to: Vec<f64>,
    /// Where the kernel has each spring.
    places: Vec<Option<Place>>,
}

impl Rest {
    /// Of a cloth as it was given, with the rest angles of its hinges, whose first particle is `base`.
    pub(crate) fn new(
        cloth: &Cloth,
        angles: impl Iterator<Item = f64>,
        base: u32,
        layout: &Layout,
        particle_count: usize,
    ) -> Self {
        let lengths = cloth.springs.iter().map(|spring| spring.rest_length);
        let given: Vec<f64> = lengths.chain(angles).collect();
        let places_of = |is_bend: bool| {
            let springs = cloth.springs.iter();
            let chosen = springs.filter(|spring| (spring.kind == SpringKind::Bend) == is_bend);
            let pairs = chosen.map(|spring| spring.ends.map(|end| base + end));
            layout.places(pairs, particle_count, is_bend).into_iter()
        };
        let (mut bends, mut others) = (places_of(true), places_of(false));
        let place = |kind| if kind == SpringKind::Bend { bends.next() } else { others.next() };
        let kinds = cloth.springs.iter().map(|spring| spring.kind);
        let places = kinds.map(place).map(Option::flatten).collect();
        Self { from: given.clone(), to: given.clone(), given, places }
    }

    /// Sends rest lengths to those of a rest shape (m) with shrink, the cloth's own shape if none is given, without any if
    /// empty; and rest angles to those of the shape.
    pub(crate) fn aim(
        &mut self,
        cloth: &Cloth,
        shape: Option<&[Vector]>,
        angles: impl Iterator<Item = f64>,
        shrink: &[f64],
    ) {
        let (_, given_angles) = self.given.split_at(cloth.springs.len());
        let (_, to) = self.to.split_at_mut(cloth.springs.len());
        to.copy_from_slice(given_angles);
        for (to, angle) in to.iter_mut().zip(angles) {
            *to = angle;
        }
        let factor = |end: u32| shrink.get(end as usize).map_or(1.0, |shrink| 1.0 - shrink);
        let springs = cloth.springs.iter().zip(&self.given);
        for (to, (spring, given)) in self.to.iter_mut().zip(springs) {
            if spring.kind == SpringKind::Sewing {
                continue;
            }
            let [a, b] = spring.ends;
            let whole =
                shape.map_or(*given, |shape| (shape[a as usize] - shape[b as usize]).norm());
            let factors = factor(a) * factor(b);
            *to = (whole * factors.sqrt()).max(CLOSED);
        }
    }

    /// The rest lengths as the frame begins and as it ends.
    pub(crate) fn both(&self) -> [&[f64]; 2] {
        [&self.from, &self.to]
    }

    /// Takes up what [`Self::both`] gave; empty: where the frame ends as the cloth was given, where it begins as it ends.
    pub(crate) fn restore(&mut self, from: &[f64], to: &[f64]) {
        self.to.copy_from_slice(if to.is_empty() { &self.given } else { to });
        self.from.copy_from_slice(if from.is_empty() { &self.to } else { from });
    }

    /// Whether they change over the frame.
    pub(crate) fn moves(&self) -> bool {
        self.from != self.to
    }

    /// Ends the frame: what it led to is where the next begins.
    pub(crate) fn arrive(&mut self) {
        self.from.copy_from_slice(&self.to);
    }

    /// Gives springs, kernel and fabrics the rest lengths and angles after a part of the frame.
    pub(crate) fn put(
        &self,
        part: f64,
        number: usize,
        cloth: &mut Cloth,
        layout: &mut Layout,
        fabrics: &mut Fabrics,
    ) {
        // What arrives is exactly there.
        let between =
            |(from, to): (&f64, &f64)| if part >= 1.0 { *to } else { from + part * (to - from) };
        let mut present = self.from.iter().zip(&self.to).map(between);
        for ((spring, place), present) in
            cloth.springs.iter_mut().zip(&self.places).zip(&mut present)
        {
            spring.rest_length = present;
            if let Some(place) = place {
                layout.set_rest_length(*place, spring.rest_length);
            }
        }
        if cloth.fabric.is_some() {
            let angles: Vec<f64> = present.collect();
            fabrics.put_rest(number, &cloth.springs, &self.given, &angles);
        }
    }

    /// Gives springs the rest lengths of the cloth as it was given.
    pub(crate) fn put_given(&self, cloth: &mut Cloth) {
        for (spring, given) in cloth.springs.iter_mut().zip(&self.given) {
            spring.rest_length = *given;
        }
    }

    /// For each vertex, how far its edges have shrunk: the least ratio of rest length to that given, at most 1.
    pub(crate) fn scales(&self, cloth: &Cloth) -> Vec<f64> {
        let mut scales = vec![1.0_f64; cloth.positions.len()];
        for (spring, given) in cloth.springs.iter().zip(&self.given) {
            if spring.kind == SpringKind::Stretch {
                for end in spring.ends {
                    let scale = &mut scales[end as usize];
                    *scale = scale.min(spring.rest_length / given);
                }
            }
        }
        scales
    }
}
