//! All winds: what the air does now, everywhere.
//!
//! Within a step the air stands still in time. Turbulence that the wind carries along depends on how far it has carried it: the
//! drift, a part of the state.

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::faces::{FaceState, Faces};
use super::shelter::Shelter;
use super::wind::{Region, Wind, WindLaw, vertex_mask};
use crate::cloth::Cloth;
use crate::collider::Collider;
use crate::kernel::CHUNK;
use crate::state::State;

/// One wind and where it has come.
#[derive(Debug)]
struct Blowing {
    wind: Wind,
    /// For regions of vertices, whether it blows on each particle.
    mask: Option<Vec<bool>>,
    /// How far (m) the mean wind has come by the start of the frame.
    drift: Vector,
    /// For each face, the part that feels the wind; empty if all do wholly.
    exposed: Vec<f64>,
}

/// All winds.
#[derive(Debug, Default)]
pub(super) struct Winds {
    each: Vec<Blowing>,
    /// When (s) the frame starts, and how far (s) into it the present step ends.
    time: [f64; 2],
}

/// For each wind the velocity (m/s) that comes to each face; one number if it is the same everywhere.
#[derive(Debug, Default)]
pub(super) struct Streams(Vec<Vec<Vector>>);

impl Streams {
    fn at(&self, wind: usize, face: usize) -> Vector {
        match self.0[wind].as_slice() {
            [same] => *same,
            each => each[face],
        }
    }
}

impl Winds {
    pub(super) fn new(winds: Vec<Wind>, cloths: &[Cloth]) -> Self {
        let each = winds.into_iter().map(|wind| Blowing {
            mask: vertex_mask(&wind.region, cloths),
            wind,
            drift: Vector::zeros(),
            exposed: Vec::new(),
        });
        Self { each: each.collect(), ..Self::default() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    pub(super) fn count(&self) -> usize {
        self.each.len()
    }

    pub(super) fn set_velocity(&mut self, wind: usize, velocity: Vector) {
        self.each[wind].wind.velocity = velocity;
    }

    /// Mean velocity (m/s) and drift (m) of each.
    pub(super) fn states(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> {
        self.each.iter().map(|blowing| [blowing.wind.velocity, blowing.drift])
    }

    pub(super) fn restore(&mut self, states: &[[Vector; 2]]) {
        for (blowing, [velocity, drift]) in self.each.iter_mut().zip(states) {
            (blowing.wind.velocity, blowing.drift) = (*velocity, *drift);
        }
    }

    /// Begins a frame that starts after so many seconds.
    pub(super) fn start_frame(&mut self, time: f64) {
        self.time = [time, 0.0];
    }

    /// Begins a step that ends so many seconds into the frame.
    pub(super) fn start_step(&mut self, end: f64) {
        self.time[1] = end;
    }

    /// Ends a frame of a duration (s).
    pub(super) fn end_frame(&mut self, duration: f64) {
        for blowing in &mut self.each {
            blowing.drift += duration * blowing.wind.velocity;
        }
    }

    /// Whether colliders keep any wind off.
    pub(super) fn are_sheltered(&self) -> bool {
        self.each.iter().any(|blowing| blowing.wind.is_sheltered)
    }

    /// Finds what feels the wind among colliders whose points are there (m).
    pub(super) fn shelter(
        &mut self,
        colliders: &[Collider],
        points: &[Vector],
        faces: &Faces,
        state: &State,
    ) {
        for blowing in self.each.iter_mut().filter(|blowing| blowing.wind.is_sheltered) {
            let Some(shelter) = Shelter::new(colliders, points, &blowing.wind.velocity) else {
                blowing.exposed.clear();
                continue;
            };
            let mut feels = vec![false; state.len()];
            feels.par_iter_mut().with_min_len(CHUNK / 8).enumerate().for_each(|(point, feels)| {
                *feels = !shelter.covers(&state.position.get(point));
            });
            let exposed = (0..faces.count()).map(|face| {
                let corners = faces.corners(face);
                let feeling = corners.iter().filter(|&&corner| feels[corner as usize]).count();
                feeling as f64 / corners.len() as f64
            });
            blowing.exposed = exposed.collect();
        }
    }

    /// Looks at what comes to each face.
    pub(super) fn observe(&self, faces: &[FaceState], streams: &mut Streams) {
        streams.0.resize_with(self.each.len(), Vec::new);
        let [start, end] = self.time;
        for (Blowing { wind, drift, exposed, .. }, stream) in self.each.iter().zip(&mut streams.0) {
            let mean = match wind.gusts {
                Some(gusts) => wind.velocity * gusts.factor(start + end),
                None => wind.velocity,
            };
            if wind.turbulence.is_none() && exposed.is_empty() {
                stream.clear();
                stream.push(mean);
                continue;
            }
            let carried = drift + end * wind.velocity;
            let speed = wind.velocity.norm();
            stream.resize(faces.len(), Vector::zeros());
            let each = stream.par_iter_mut().zip(faces).enumerate();
            each.with_min_len(CHUNK / 8).for_each(|(number, (stream, face))| {
                let place = face.middle - carried;
                let eddy = wind.turbulence.map(|turbulence| turbulence.velocity(&place, speed));
                let part = exposed.get(number).map_or(1.0, |part| *part);
                *stream = part * (mean + eddy.unwrap_or_default());
            });
        }
    }

    /// Largest damping (N·s/m) that the classic law puts on a particle.
    pub(super) fn damping(&self) -> f64 {
        let coefficients = |of: Option<u32>| {
            let on_it = move |blowing: &&Blowing| match blowing.wind.region {
                Region::Cloth(cloth, _) => of == Some(cloth),
                _ => of.is_none(),
            };
            let each = self.each.iter().filter(on_it).map(|blowing| match blowing.wind.law {
                WindLaw::Vertex { coefficient } => coefficient,
                WindLaw::Face(_) => 0.0,
            });
            each.sum::<f64>()
        };
        let own = self.each.iter().filter_map(|blowing| match blowing.wind.region {
            Region::Cloth(cloth, _) => Some(coefficients(Some(cloth))),
            _ => None,
        });
        coefficients(None) + own.fold(0.0, f64::max)
    }

    /// Damping (N·s/m) of a particle among faces, at most; as they were last observed.
    pub(super) fn damping_of<'a>(
        &self,
        particle: usize,
        around: &(impl Iterator<Item = (usize, &'a FaceState)> + Clone),
        streams: &Streams,
    ) -> f64 {
        let blowing = self.each.iter().enumerate();
        let blowing = blowing.filter(|(_, blowing)| reaches(blowing.mask.as_ref(), particle));
        let each = blowing.map(|(number, blowing)| match blowing.wind.law {
            WindLaw::Vertex { coefficient } => coefficient,
            WindLaw::Face(flow) => around
                .clone()
                .map(|(index, face)| {
                    let w = streams.at(number, index) - face.velocity;
                    let dry = face.corner_share * face.area * (1.0 - face.immersed);
                    flow.slope(dry, &w, &face.normal)
                })
                .sum(),
        });
        each.sum()
    }

    /// For each wind by face: the slope (N·s/m³) of its force on each m² at most, of faces by how fast (m/s) they are, and whether
    /// it reaches a particle.
    pub(super) fn slopes(&self) -> Vec<(impl Fn(f64) -> f64, impl Fn(usize) -> bool)> {
        let pressing = self.each.iter().filter_map(|blowing| match blowing.wind.law {
            WindLaw::Face(flow) => Some((flow, blowing.wind.most_speed(), blowing.mask.as_ref())),
            WindLaw::Vertex { .. } => None,
        });
        let each = pressing.map(|(flow, most, mask)| {
            let slope = move |own: f64| flow.most_slope(most + own);
            (slope, move |particle: usize| reaches(mask, particle))
        });
        each.collect()
    }

    /// Adds what they do (N) to a particle that is there and moves so.
    pub(super) fn add_force<'a>(
        &self,
        particle: usize,
        [position, velocity]: [Vector; 2],
        around: &(impl Iterator<Item = (usize, &'a FaceState)> + Clone),
        streams: &Streams,
        force: &mut Vector,
    ) {
        for (number, Blowing { wind, mask, .. }) in self.each.iter().enumerate() {
            let blows = match &wind.region {
                Region::Box(region) => region.contains(&position),
                _ => reaches(mask.as_ref(), particle),
            };
            if !blows {
                continue;
            }
            match wind.law {
                WindLaw::Vertex { coefficient } => {
                    let sum: Vector = around.clone().map(|(_, face)| face.normal).sum();
                    let normal = sum.try_normalize(1e-12).unwrap_or_else(Vector::zeros);
                    let (mut stream, mut dry, mut count) = (Vector::zeros(), 0.0, 0.0);
                    for (index, face) in around.clone() {
                        stream += streams.at(number, index);
                        dry += 1.0 - face.immersed;
                        count += 1.0;
                    }
                    let w = stream / f64::max(count, 1.0) - velocity;
                    *force += coefficient * (dry / f64::max(count, 1.0)) * w.dot(&normal) * normal;
                }
                WindLaw::Face(flow) => {
                    for (index, face) in around.clone() {
                        let w = streams.at(number, index) - face.velocity;
                        let dry = face.corner_share * face.area * (1.0 - face.immersed);
                        *force += flow.force(dry, &w, &face.normal);
                    }
                }
            }
        }
    }
}

/// Whether a wind with a mask blows on a particle; without one it may, wherever it is.
fn reaches(mask: Option<&Vec<bool>>, particle: usize) -> bool {
    mask.is_none_or(|mask| mask[particle])
}
