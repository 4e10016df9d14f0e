//! Pins: particles that go where they are told, or are drawn there.
//!
//! Over a frame the goal of a pin moves in a straight line to its target. A pin of weight 1 is hard: it moves with its
//! goal, at the velocity that takes it there, so that damping and limiters see it move, and at the frame's end it is put
//! exactly on its target. One of a weight w below 1 is soft: a goal spring ([`crate::goals`]) draws it to the goal y,
//!
//! ```text
//! F_i = k_i (y_i - x_i) + c_i (y_i' - v_i)        k_i = w_i K m_i/m_patch        c_i = 2 zeta sqrt(k_i m_i)
//! ```
//!
//! K is the stiffness (N/m) of a whole patch: of all pins that edges join, of any weight, which share it by mass. So what
//! hangs on a patch sags by weight/K however fine the mesh is, be the patch a corner, a row or a painted area. A pin of
//! weight 0 is free.
//!
//! Weights may change from frame to frame. Who becomes softer flies on with the velocity it has; who becomes hard is taken
//! to its target within the frame.

use boucle_geometry::Vector;

use crate::cloth::{Cloth, placed};
use crate::goals::Goal;
use crate::material::SpringKind;
use crate::state::State;

/// One pin of any weight.
#[derive(Clone, Copy, Debug)]
struct Pin {
    particle: u32,
    /// The number of its cloth.
    cloth: u32,
    /// (kg)
    mass: f64,
    /// Its part of its patch, by mass.
    share: f64,
    held: Held,
}

/// What changes about a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    /// 0 free, 1 hard.
    pub(crate) weight: f64,
    /// Where its goal is to be at the end of the next frame (m).
    pub(crate) target: Vector,
    /// Where its goal is now (m).
    pub(crate) goal: Vector,
}

/// The pins of all cloths, by particle.
#[derive(Debug, Default)]
pub(crate) struct Pins {
    all: Vec<Pin>,
    /// Stiffness (N/m) of a patch of weight 1, of each cloth.
    stiffness: Vec<f64>,
    damping_ratio: Vec<f64>,
}

impl Pins {
    pub(crate) fn new(cloths: &[Cloth], state: &State) -> Self {
        let mut pins = Vec::new();
        for (number, (cloth, base)) in placed(cloths).enumerate() {
            let mut own: Vec<_> = (cloth.pins.iter().enumerate())
                .map(|(i, &pin)| (pin, cloth.pin_weights.get(i).copied().unwrap_or(1.0)))
                .collect();
            own.sort_by_key(|&(pin, _)| pin);
            own.dedup_by(|later, kept| {
                let is_same = later.0 == kept.0;
                if is_same {
                    kept.1 = later.1;
                }
                is_same
            });
            let masses = patch_masses(cloth, own.iter().map(|&(pin, _)| pin));
            pins.extend(own.iter().map(|&(vertex, weight)| {
                let (particle, mass) = (base + vertex, cloth.masses[vertex as usize]);
                let position = state.position.get(particle as usize);
                let held = Held { weight, target: position, goal: position };
                let share = mass / masses[vertex as usize];
                Pin { particle, cloth: number as u32, mass, share, held }
            }));
        }
        Self {
            all: pins,
            stiffness: cloths.iter().map(|cloth| cloth.pin_material.stiffness).collect(),
            damping_ratio: cloths.iter().map(|cloth| cloth.pin_material.damping_ratio).collect(),
        }
    }

    /// The particles that hard pins hold.
    pub(crate) fn particles(&self) -> impl Iterator<Item = u32> {
        self.hard().map(|pin| pin.particle)
    }

    fn hard(&self) -> impl Iterator<Item = &Pin> {
        self.all.iter().filter(|pin| pin.held.weight >= 1.0)
    }

    /// The goal springs of soft pins.
    pub(crate) fn goals(&self) -> impl Iterator<Item = Goal> {
        let soft = self.all.iter().filter(|pin| pin.held.weight > 0.0 && pin.held.weight < 1.0);
        soft.map(|pin| {
            let cloth = pin.cloth as usize;
            let stiffness = pin.held.weight * self.stiffness[cloth] * pin.share;
            let damping = 2.0 * self.damping_ratio[cloth] * (stiffness * pin.mass).sqrt();
            let Held { target, goal, .. } = pin.held;
            Goal { particle: pin.particle, stiffness, damping, from: goal, to: target }
        })
    }

    /// Sets the targets of the pins for which there is one.
    pub(crate) fn aim(&mut self, target_of: impl Fn(u32) -> Option<Vector>) {
        for Pin { particle, held, .. } in &mut self.all {
            held.target = target_of(*particle).unwrap_or(held.target);
        }
    }

    /// Puts the hard pins for which there is a place there, at rest; soft ones are drawn to where they were.
    pub(crate) fn place(&mut self, place_of: impl Fn(u32) -> Option<Vector>) {
        for Pin { particle, held, .. } in self.all.iter_mut().filter(|pin| pin.held.weight >= 1.0) {
            if let Some(place) = place_of(*particle) {
                (held.target, held.goal) = (place, place);
            }
        }
    }

    /// Sets the weights of the pins for which there is one.
    pub(crate) fn weigh(&mut self, weight_of: impl Fn(u32) -> Option<f64>) {
        for Pin { particle, held, .. } in &mut self.all {
            held.weight = weight_of(*particle).unwrap_or(held.weight);
        }
    }

    /// Sets the stiffness (N/m) of a cloth's patches.
    pub(crate) fn stiffen(&mut self, cloth: usize, stiffness: f64) {
        self.stiffness[cloth] = stiffness;
    }

    /// Sends the hard pins off to their targets, to arrive after `duration` seconds.
    pub(crate) fn start(&self, state: &mut State, duration: f64) {
        for pin in self.hard() {
            let particle = pin.particle as usize;
            let position = state.position.get(particle);
            state.velocity.set(particle, &((pin.held.target - position) / duration));
        }
    }

    /// The largest change of a hard pin's velocity (m/s) if it is to arrive after `duration` seconds.
    pub(crate) fn largest_change(&self, state: &State, duration: f64) -> f64 {
        let changes = self.hard().map(|pin| {
            let particle = pin.particle as usize;
            let way = pin.held.target - state.position.get(particle);
            (way / duration - state.velocity.get(particle)).norm()
        });
        changes.fold(0.0, f64::max)
    }

    /// The longest way (m) that a hard pin is to go.
    pub(crate) fn longest_way(&self, state: &State) -> f64 {
        let ways = self.hard().map(|pin| {
            (pin.held.target - state.position.get(pin.particle as usize)).norm_squared()
        });
        ways.fold(0.0, f64::max).sqrt()
    }

    /// Puts the hard pins on their targets.
    pub(crate) fn arrive(&self, state: &mut State) {
        for pin in self.hard() {
            state.position.set(pin.particle as usize, &pin.held.target);
        }
    }

    /// Ends a frame: all goals are where they were to be.
    pub(crate) fn end_frame(&mut self) {
        for Pin { held, .. } in &mut self.all {
            held.goal = held.target;
        }
    }

    /// What changes: of each pin, and the stiffness of each cloth.
    pub(crate) fn held(&self) -> (Vec<Held>, Vec<f64>) {
        (self.all.iter().map(|pin| pin.held).collect(), self.stiffness.clone())
    }

    /// The particles of all pins, in the order of [`Self::held`].
    pub(crate) fn all(&self) -> impl Iterator<Item = u32> {
        self.all.iter().map(|pin| pin.particle)
    }

    /// Whether what [`Self::held`] gave is of these pins.
    pub(crate) fn fit(&self, held: &[Held], stiffness: &[f64]) -> bool {
        held.len() == self.all.len() && stiffness.len() == self.stiffness.len()
    }

    /// Takes it up.
    pub(crate) fn restore(&mut self, held: &[Held], stiffness: &[f64]) {
        for (pin, held) in self.all.iter_mut().zip(held) {
            pin.held = *held;
        }
        self.stiffness.copy_from_slice(stiffness);
    }
}

/// The mass (kg) of the patch of each pinned vertex; 0 of the others.
fn patch_masses(cloth: &Cloth, pins: impl Iterator<Item = u32> + Clone) -> Vec<f64> {
    let mut is_pin = vec![false; cloth.positions.len()];
    pins.clone().for_each(|pin| is_pin[pin as usize] = true);
    let mut root_of: Vec<u32> = (0..cloth.positions.len() as u32).collect();
    for spring in cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch) {
        if spring.ends.iter().all(|&end| is_pin[end as usize]) {
            let [a, b] = spring.ends.map(|end| root(&mut root_of, end));
            root_of[a.max(b) as usize] = a.min(b);
        }
    }
    let mut masses = vec![0.0; cloth.positions.len()];
    for pin in pins.clone() {
        masses[root(&mut root_of, pin) as usize] += cloth.masses[pin as usize];
    }
    // A root keeps its own sum, so that the order does not matter.
    for pin in pins {
        masses[pin as usize] = masses[root(&mut root_of, pin) as usize];
    }
    masses
}

/// The first vertex of the patch so far, with the way there made shorter.
fn root(root_of: &mut [u32], mut vertex: u32) -> u32 {
    while root_of[vertex as usize] != vertex {
        let next = root_of[root_of[vertex as usize] as usize];
        root_of[vertex as usize] = next;
        vertex = next;
    }
    vertex
}
