//! All force fields on all vertices.
//!
//! Magnetic forces do no work, but with steps of h seconds they would: they turn a velocity by their rate w (1/s), and
//! what an implicit step makes of a turn by much more than `w h = 1/10` depends on how often it is iterated. So the rate
//! is limited to that, above what cloth in a magnetic field of Blender's usual strengths asks for (a strength of 1
//! turns cloth of 0.2 kg/m² by 2.4 a second, steps are of some milliseconds). Explicit steps would add the square of the
//! angle to the energy: they are limited to a much smaller one.

use boucle_geometry::Vector;

use super::faces::FaceState;
use super::field::{Field, Push, draw};

/// Largest turn by magnetic fields in a step.
const IMPLICIT_TURN: f64 = 0.1;
const EXPLICIT_TURN: f64 = 0.02;

/// What the fields do to one vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pushed {
    /// N
    pub(super) force: Vector,
    /// Slows no more than so much (N·s/m).
    pub(super) damping: f64,
    /// Holds no more than so much (N/m).
    pub(super) stiffness: f64,
}

/// The fields of a frame.
#[derive(Debug, Default)]
pub(crate) struct Fields {
    each: Vec<Field>,
    frame: i32,
    /// Fastest turn (1/s) by magnetic fields.
    most_turn: f64,
    masses: Vec<f64>,
}

impl Fields {
    pub(super) fn new(masses: Vec<f64>) -> Self {
        Self { masses, ..Self::default() }
    }

    pub(super) fn set(&mut self, fields: Vec<Field>) {
        self.each = fields;
    }

    pub(super) fn each(&self) -> &[Field] {
        &self.each
    }

    pub(super) fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    /// Begins the frame after this one; turns are limited by steps only.
    pub(super) fn start_frame(&mut self, frame: i32) {
        (self.frame, self.most_turn) = (frame, f64::INFINITY);
    }

    /// Begins the steps of a frame, of h seconds each.
    pub(super) fn start_steps(&mut self, h: f64, is_implicit: bool) {
        self.most_turn = if is_implicit { IMPLICIT_TURN } else { EXPLICIT_TURN } / h;
    }

    /// What they do to a vertex among its faces; it may become faster by `gain` (m/s) while they act.
    pub(super) fn push<'a>(
        &self,
        particle: usize,
        [x, v]: [Vector; 2],
        faces: impl Iterator<Item = &'a FaceState> + Clone,
        gain: f64,
    ) -> Pushed {
        let mut push = Push::default();
        for field in &self.each {
            let random =
                if field.noise == 0.0 { 0.0 } else { draw(field.seed, self.frame, particle) };
            field.push(&x, &v, random, gain, &mut push);
        }
        let area: f64 = faces.clone().map(|face| face.corner_share * face.area).sum();
        let limit = self.most_turn * self.masses[particle] / area.max(f64::MIN_POSITIVE);
        let size = push.turn.norm();
        let turn = if size > limit { push.turn * (limit / size) } else { push.turn };
        let mut force = area * (push.free + v.cross(&turn));
        if push.normal != Vector::zeros() {
            for face in faces {
                let pressure = push.normal.dot(&face.normal);
                force += face.corner_share * face.area * pressure * face.normal;
            }
        }
        // With the size of the turn in the matrix, iterations come nearer to the step's end.
        Pushed {
            force,
            damping: area * (push.damping + turn.norm()),
            stiffness: area * push.stiffness,
        }
    }
}
