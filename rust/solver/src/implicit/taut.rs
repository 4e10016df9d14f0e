//! Edges at their allowed length: a tension that holds them there, part of the implicit step.
//!
//! An edge longer than `(1 + rate) L0` pulls with a tension of its own beside its spring's,
//!
//! ```text
//! T = max(0, T0 + kappa (l - (1 + rate) L0))
//! ```
//!
//! where T0 is what it was after the last iteration: the multiplier of an augmented Lagrangian. It grows from step to
//! step until the edge is held, and goes to 0 by itself where the load does. What it leaves the limiter takes away: a
//! few percent instead of the tens that soft springs stretch beside a pin. Only the limiter `project` uses it.
//!
//! Source: Hestenes 1969 and Powell 1969 for the multipliers.

use rayon::prelude::*;

use crate::cloth::{Cloth, placed};
use crate::kernel::{Layout, Place};
use crate::law::Spring;
use crate::limit::acting;
use crate::linear::{Field, Operator};
use crate::material::{Limiter, SpringKind};
use crate::state::Coordinates;
use crate::system::System;

/// kappa by the stiffness of the edge's spring. With 2, strain beyond the limit falls to a third from one step to the
/// next; with 5, Newton iterations begin to overshoot.
const KAPPA: f64 = 2.0;

/// Tension never exceeds that of kappa at so much strain, and so many times the cloth's weight: it would grow for ever
/// where pins alone force more strain than is allowed.
const MOST_STRAIN: f64 = 8.0;
const MOST_WEIGHTS: f64 = 20.0;

/// Edges that one task looks at.
const CHUNK: usize = 4096;

#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [u32; 2],
    /// (m)
    allowed: f64,
    /// (N/m)
    kappa: f64,
    /// Largest tension (N) but for what weight adds.
    most: f64,
    /// Of its cloth (kg).
    mass: f64,
    /// Of its spring.
    place: Place,
}

impl Edge {
    /// Largest tension (N) under a gravity (m/s²).
    fn most(&self, gravity: f64) -> f64 {
        self.most + MOST_WEIGHTS * gravity * self.mass
    }
}

/// An edge that pulls, frozen at one state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulling {
    edge: u32,
    pub(super) place: Place,
    ends: [u32; 2],
    /// (N)
    tension: f64,
    normal: [f64; 3],
    /// `kappa - T/l` and `T/l` (N/m).
    along: f32,
    across: f32,
    is_free: [bool; 2],
}

impl Pulling {
    /// Adds its tangents to those of its spring: `sqrt(alpha) n` and beta.
    pub(super) fn add_to(&self, [x, y, z, beta]: [&mut f32; 4]) {
        let alpha = *x * *x + *y * *y + *z * *z + self.along;
        let root = alpha.sqrt();
        [*x, *y, *z] = self.normal.map(|n| root * n as f32);
        *beta += self.across;
    }
}

/// The edges that may become taut.
#[derive(Debug)]
pub(super) struct Taut {
    edges: Vec<Edge>,
    /// Present tension of each edge.
    tensions: Vec<f64>,
    pulling: Vec<Pulling>,
    /// Factor of kappa at the last freeze.
    stiffer: f64,
    /// Gravity (m/s²) at the last freeze.
    gravity: f64,
}

impl Taut {
    pub(super) fn new(cloths: &[Cloth], layout: &Layout) -> Self {
        let mut edges = Vec::new();
        let count = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        for (cloth, base) in placed(cloths) {
            let allowed = 1.0 + cloth.material.deformation_rate;
            let mass = cloth.masses.iter().sum::<f64>();
            if acting(cloth, true) != Limiter::Project {
                continue;
            }
            let is_stretch = |spring: &&Spring| spring.kind == SpringKind::Stretch;
            let stretch: Vec<_> = cloth.springs.iter().filter(is_stretch).collect();
            let ends = |spring: &&Spring| spring.ends.map(|end| base + end);
            let places = layout.places(stretch.iter().map(ends), count, false);
            edges.extend(stretch.iter().zip(places).filter_map(|(spring, place)| {
                let kappa = KAPPA * spring.stiffness;
                Some(Edge {
                    ends: ends(spring),
                    allowed: allowed * spring.rest_length,
                    kappa,
                    most: MOST_STRAIN * kappa * spring.rest_length,
                    mass,
                    place: place?,
                })
            }));
        }
        let tensions = vec![0.0; edges.len()];
        Self { edges, tensions, pulling: Vec::new(), stiffer: 1.0, gravity: 0.0 }
    }

    /// Takes the present rest lengths of a cloth's springs; `base` is the number of its first particle.
    pub(super) fn follow_rest_lengths(&mut self, cloth: &Cloth, base: u32) {
        let allowed = 1.0 + cloth.material.deformation_rate;
        let particles = base..base + cloth.positions.len() as u32;
        let mut edges = self.edges.iter_mut().filter(|edge| particles.contains(&edge.ends[0]));
        let mut next = edges.next();
        for spring in cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch) {
            let Some(edge) = &mut next else { return };
            if edge.ends != spring.ends.map(|end| base + end) {
                continue;
            }
            edge.allowed = allowed * spring.rest_length;
            edge.most = MOST_STRAIN * edge.kappa * spring.rest_length;
            next = edges.next();
        }
    }

    /// The edges that pull, as the last freeze found them.
    pub(super) fn pulling(&self) -> &[Pulling] {
        &self.pulling
    }

    /// The ends of each edge, in the order of its tension.
    pub(super) fn ends(&self) -> impl Iterator<Item = [u32; 2]> {
        self.edges.iter().map(|edge| edge.ends)
    }

    pub(super) fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// Finds the edges that pull at these positions, given their tensions (N) after the last iteration.
    pub(super) fn freeze(
        &mut self,
        positions: &Coordinates,
        last: &[f64],
        stiffer: f64,
        system: &System,
    ) {
        self.stiffer = stiffer;
        self.gravity = system.gravity.norm();
        let gravity = self.gravity;
        let chunks = self.tensions.par_chunks_mut(CHUNK).zip(self.edges.par_chunks(CHUNK));
        chunks.zip(last.par_chunks(CHUNK)).for_each(|((tensions, edges), last)| {
            for ((tension, edge), last) in tensions.iter_mut().zip(edges).zip(last) {
                let [a, b] = edge.ends;
                let squared = positions.distance_squared(a, b);
                *tension = if *last == 0.0 && squared <= edge.allowed * edge.allowed {
                    0.0
                } else {
                    (last + stiffer * edge.kappa * (squared.sqrt() - edge.allowed))
                        .clamp(0.0, stiffer * edge.most(gravity))
                };
            }
        });
        self.pulling.clear();
        for (number, (&tension, edge)) in self.tensions.iter().zip(&self.edges).enumerate() {
            let is_free = edge.ends.map(|end| !system.is_pinned(end as usize));
            if tension == 0.0 || is_free == [false; 2] {
                continue;
            }
            let [a, b] = edge.ends.map(|end| end as usize);
            let span = positions.0.each_ref().map(|axis| axis[a] - axis[b]);
            let length = positions.distance_squared(edge.ends[0], edge.ends[1]).sqrt();
            self.pulling.push(Pulling {
                edge: number as u32,
                place: edge.place,
                ends: edge.ends,
                tension,
                normal: span.map(|d| d / length),
                along: (stiffer * edge.kappa - tension / length).max(0.0) as f32,
                across: (tension / length) as f32,
                is_free,
            });
        }
    }

    /// The largest excess of an edge over its allowed length, relative, at the last freeze's positions.
    pub(super) fn largest_excess(&self, positions: &Coordinates) -> f64 {
        let excess = self.pulling.iter().map(|pulling| {
            let [a, b] = pulling.ends;
            let allowed = self.edges[pulling.edge as usize].allowed;
            positions.distance_squared(a, b).sqrt() / allowed - 1.0
        });
        excess.fold(0.0, f64::max)
    }

    /// Adds the tensions to the forces (N).
    pub(super) fn add_forces(&self, forces: &mut Coordinates) {
        for pulling in &self.pulling {
            let [a, b] = pulling.ends.map(|end| end as usize);
            for (force, n) in forces.0.iter_mut().zip(pulling.normal) {
                let pull = pulling.tension * n;
                if pulling.is_free[0] {
                    force[a] -= pull;
                }
                if pulling.is_free[1] {
                    force[b] += pull;
                }
            }
        }
    }

    /// Takes the tensions that the linear model has after a move (m).
    pub(super) fn follow(&self, moves: &Field, tensions: &mut [f64]) {
        tensions.fill(0.0);
        for pulling in &self.pulling {
            let [a, b] = pulling.ends.map(|end| end as usize);
            let spans = moves.0.iter().map(|axis| f64::from(axis[a] - axis[b]));
            let along: f64 = spans.zip(pulling.normal).map(|(d, n)| d * n).sum();
            let edge = &self.edges[pulling.edge as usize];
            let tension = pulling.tension + self.stiffer * edge.kappa * along;
            tensions[pulling.edge as usize] =
                tension.clamp(0.0, self.stiffer * edge.most(self.gravity));
        }
    }
}

/// A matrix with that of the tensions.
pub(super) struct WithTaut<'a, Matrix> {
    pub(super) matrix: Matrix,
    pub(super) taut: &'a Taut,
}

impl<Matrix: Operator> Operator for WithTaut<'_, Matrix> {
    fn apply(&self, p: &Field, out: &mut Field) {
        self.matrix.apply(p, out);
        for pulling in &self.taut.pulling {
            let [a, b] = pulling.ends.map(|end| end as usize);
            let d: [f32; 3] = std::array::from_fn(|axis| p.0[axis][a] - p.0[axis][b]);
            let n = pulling.normal.map(|n| n as f32);
            let along = pulling.along * (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
            for (axis, out) in out.0.iter_mut().enumerate() {
                let force = along * n[axis] + pulling.across * d[axis];
                if pulling.is_free[0] {
                    out[a] += force;
                }
                if pulling.is_free[1] {
                    out[b] -= force;
                }
            }
        }
    }
}
