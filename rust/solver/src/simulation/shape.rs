//! What changes a cloth's shape from frame to frame: rest lengths, pressure, seams that weld.

use boucle_geometry::Vector;

use super::Simulation;
use crate::cloth::check_positions;
use crate::error::{Error, Result};
use crate::limit::Limit;
use crate::material::SpringKind;
use crate::rest::Rest;
use crate::tailoring::check_shrink;

impl Simulation {
    /// What the rest lengths of a cloth are to be at the end of the next frame: those of a rest shape (m), its own if `None`,
    /// with shrink at each vertex, as the cloth was given if `None`. Over the frame they change evenly.
    ///
    /// # Errors
    /// [`Error::BadCloth`] when there are not as many numbers as vertices, or one is out of its domain.
    pub fn set_rest(
        &mut self,
        cloth: usize,
        shape: Option<&[Vector]>,
        shrink: Option<&[f64]>,
    ) -> Result<()> {
        let given = self.given(cloth);
        let count = given.positions.len();
        if let Some(shape) = shape {
            if shape.len() != count {
                let got = shape.len();
                let reason = format!("{got} rest positions are given; accepted: {count}");
                return Err(Error::BadCloth { cloth: given.name.clone(), reason });
            }
            check_positions(&given.name, shape)?;
        }
        check_shrink(&given.name, shrink.unwrap_or(&[]), count)?;
        self.ensure_rest(cloth);
        let own = &self.cloths[cloth];
        let shape = shape.map(|shape| own.over_pieces(shape));
        let shrink = shrink.map(|shrink| own.over_pieces(shrink));
        let (shape, shrink) = (shape.as_deref(), shrink.as_deref());
        if let Some(rest) = &mut self.rests[cloth] {
            let (given, base) = (&self.cloths[cloth], self.bases[cloth]);
            let angles = shape.map(|shape| self.system.fabrics.angles_in(cloth, base, shape));
            let angles = angles.into_iter().flatten();
            rest.aim(given, shape, angles, shrink.unwrap_or(&given.tailoring.shrink));
        }
        Ok(())
    }

    /// The pressure of a cloth at the end of the next frame, if it was given one: see [`Pressure`](crate::Pressure).
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for a number that is not accepted.
    pub fn set_pressure(
        &mut self,
        cloth: usize,
        uniform: f64,
        factor: f64,
        target_volume: Option<f64>,
    ) -> Result<()> {
        let weights = Vec::new();
        let pressure = crate::Pressure { uniform, factor, target_volume, weights };
        pressure.check(&self.cloths[cloth].name, self.cloths[cloth].positions.len())?;
        self.system.air.pressures.aim(cloth, uniform, factor, target_volume);
        Ok(())
    }

    /// The present volume (m³) of a cloth that has a pressure.
    #[must_use]
    pub fn volume(&self, cloth: usize) -> Option<f64> {
        self.system.air.pressures.volume(cloth, &self.state)
    }

    /// How many seams of a cloth are welded.
    #[must_use]
    pub fn welded_seams(&self) -> usize {
        self.seams.welded().filter(|is_welded| *is_welded).count()
    }

    /// Begins to keep the rest lengths of a cloth, whose springs are still as they were given.
    pub(super) fn ensure_rest(&mut self, cloth: usize) {
        let Self { rests, cloths, bases, system, .. } = self;
        let count = system.particle_count();
        rests[cloth].get_or_insert_with(|| {
            let angles = system.fabrics.rest_angles(cloth);
            Box::new(Rest::new(&cloths[cloth], angles, bases[cloth], &system.layout, count))
        });
    }

    /// Shrinks cloths that are shrunk from the first.
    pub(super) fn shrink_from_the_first(&mut self) -> Result<()> {
        let shrunk = |cloth: &usize| self.cloths[*cloth].tailoring.shrink.iter().any(|s| *s != 0.0);
        let cloths: Vec<usize> = (0..self.cloths.len()).filter(shrunk).collect();
        for cloth in cloths {
            self.set_rest(cloth, None, None)?;
            self.put_rest(cloth, 1.0);
            if let Some(rest) = &mut self.rests[cloth] {
                rest.arrive();
            }
        }
        Ok(())
    }

    /// Creases cloth that starts from another shape than that at rest.
    pub(super) fn crease(&mut self) {
        let Self { threads, system, state, .. } = self;
        threads.install(|| system.fabrics.give_way(state));
    }

    /// Takes rest lengths, pressures and the force of seams after a part of the frame.
    pub(super) fn shape(&mut self, part: f64, is_start: bool) {
        for cloth in 0..self.rests.len() {
            if self.rests[cloth].as_ref().is_some_and(|rest| rest.moves()) {
                self.put_rest(cloth, part);
            }
        }
        if !self.system.air.pressures.is_empty() {
            self.system.air.pressures.put(part);
        }
        if !is_start {
            self.seams.limit(&self.state.position, &mut self.system.layout);
        }
    }

    /// Ends a frame: what it led to is where the next begins, and seams that have closed are welded.
    pub(super) fn end_shape(&mut self) {
        self.rests.iter_mut().flatten().for_each(|rest| rest.arrive());
        self.system.air.pressures.arrive();
        let Self { seams, state, cloths, system, .. } = self;
        if !seams.is_empty() && seams.weld(&state.position, cloths, &mut system.layout) {
            self.follow_welds();
        }
    }

    pub(super) fn follow_welds(&mut self) {
        self.method.follow_stiffness(&self.cloths, &self.system);
        self.follow_pins();
    }

    /// Takes the rest lengths of a cloth after a part of the frame, and the contact distances that go with them.
    pub(super) fn put_rest(&mut self, cloth: usize, part: f64) {
        let Self { rests, cloths, bases, system, method, limits, contacts, .. } = self;
        let Some(rest) = &rests[cloth] else { return };
        let (own, base) = (&mut cloths[cloth], bases[cloth]);
        rest.put(part, cloth, own, &mut system.layout, &mut system.fabrics);
        contacts.scale_rest(base, &rest.scales(own));
        method.follow_rest_lengths(own, base);
        for limit in limits {
            limit.follow_rest_lengths(own, base);
        }
    }

    /// The limiter of a cloth: its order is that of the rest lengths as they were given.
    pub(super) fn limit_of(&mut self, cloth: usize) -> Option<Limit> {
        let (own, base) = (&mut self.cloths[cloth], self.bases[cloth]);
        let (system, is_implicit) = (&self.system, self.method.is_implicit());
        let is_held = |particle: u32| system.is_held(particle as usize);
        let Some(rest) = &self.rests[cloth] else {
            return Limit::of(own, base, is_implicit, is_held);
        };
        let present: Vec<f64> = own.springs.iter().map(|spring| spring.rest_length).collect();
        rest.put_given(own);
        let limit = Limit::of(own, base, is_implicit, is_held);
        for (spring, present) in own.springs.iter_mut().zip(present) {
            spring.rest_length = present;
        }
        let mut limit = limit?;
        limit.follow_rest_lengths(own, base);
        Some(limit)
    }

    /// The seams of a cloth and how far apart (m) the ends of each are.
    #[must_use]
    pub fn seam_gaps(&self, cloth: usize) -> Vec<f64> {
        let (cloth, base) = (&self.cloths[cloth], self.bases[cloth]);
        let seams = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Sewing);
        let ends = seams.map(|seam| seam.ends.map(|end| base + end));
        ends.map(|[a, b]| self.state.position.distance_squared(a, b).sqrt()).collect()
    }
}
