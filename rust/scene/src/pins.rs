//! From the pins of a description to vertices, and to where they are at each frame.

use std::collections::BTreeMap;

use boucle_geometry::Vector;
use boucle_solver::Simulation;

use crate::assembly::RestMesh;
use crate::description::{Keyframe, PinGroup, Pins, joined};
use crate::error::{Error, Result};
use crate::grid::PLACES;
use crate::transform::motion_at;

/// The pins of one cloth: which vertices, how they move, when they let go.
#[derive(Clone, Debug)]
pub(crate) struct PinTrack {
    groups: Vec<Held>,
    /// Rest positions (m) of all vertices; empty where nothing moves.
    rest: Vec<Vector>,
}

/// Vertices that move and let go together.
#[derive(Clone, Debug)]
struct Held {
    vertices: Vec<u32>,
    /// One a vertex.
    weights: Vec<f64>,
    motion: Vec<Keyframe>,
    release: Option<i32>,
}

impl PinTrack {
    /// Finds the pinned vertices; `at` is the key of the pins.
    pub(crate) fn new(pins: &Pins, at: &str, rest: &RestMesh) -> Result<Self> {
        let mut owner = BTreeMap::new();
        for (index, group) in pins.groups.iter().enumerate() {
            let own = group.weights.iter().copied();
            let rest_of = std::iter::repeat(group.weight.unwrap_or(1.0));
            let found = vertices(group, &pins.key(at, index), rest)?;
            for (vertex, weight) in found.into_iter().zip(own.chain(rest_of)) {
                owner.insert(vertex, (index, weight));
            }
        }
        let held = |(index, group): (usize, &PinGroup)| {
            let own = owner.iter().filter(|(_, (owner, _))| *owner == index);
            let (vertices, weights) = own.map(|(&vertex, &(_, weight))| (vertex, weight)).unzip();
            Held { vertices, weights, motion: group.motion.clone(), release: group.release }
        };
        let groups: Vec<Held> = pins.groups.iter().enumerate().map(held).collect();
        let moves = groups.iter().any(|group| !group.motion.is_empty());
        let rest = if moves { rest.positions.clone() } else { Vec::new() };
        Ok(Self { groups, rest })
    }

    /// Every pinned vertex, in order, and the weight of each.
    pub(crate) fn weighted(&self) -> (Vec<u32>, Vec<f64>) {
        let all = self.groups.iter().flat_map(|group| group.vertices.iter().zip(&group.weights));
        let mut all: Vec<_> = all.map(|(&vertex, &weight)| (vertex, weight)).collect();
        all.sort_unstable_by_key(|&(vertex, _)| vertex);
        all.into_iter().unzip()
    }

    /// Readies the pins of a cloth for the step from `frame` to the next: lets go what lets go at `frame`, and sets where
    /// the others are to arrive. `first` is the first frame of the scene.
    pub(crate) fn prepare(
        &self,
        simulation: &mut Simulation,
        cloth: usize,
        frame: i32,
        first: i32,
    ) {
        for group in &self.groups {
            if group.release.map(|release| release.max(first)) == Some(frame) {
                simulation.release_pins(cloth, &group.vertices);
            }
        }
        if !self.rest.is_empty() {
            simulation.set_pin_targets(cloth, &self.targets(frame + 1));
        }
    }

    /// Where all vertices would be at a frame (m) if only their pins moved.
    fn targets(&self, frame: i32) -> Vec<Vector> {
        let mut targets = self.rest.clone();
        for group in &self.groups {
            if let Some(motion) = motion_at(&group.motion, frame) {
                for &vertex in &group.vertices {
                    targets[vertex as usize] = motion.apply(&self.rest[vertex as usize]);
                }
            }
        }
        targets
    }
}

/// The vertices of one group.
fn vertices(group: &PinGroup, at: &str, rest: &RestMesh) -> Result<Vec<u32>> {
    let count = rest.positions.len();
    for (index, &vertex) in group.vertices.iter().enumerate() {
        if vertex as usize >= count {
            let accepted = format!("0 to {}", count.saturating_sub(1));
            return Err(Error::refuse(&format!("{at}.vertices.{index}"), vertex, &accepted));
        }
    }
    let mut found = group.vertices.clone();
    for name in &group.names {
        found.extend(named(name, at, rest)?);
    }
    if let (Some(near), Some(radius)) = (group.near, group.radius) {
        let middle = Vector::from(near);
        let is_near = |position: &Vector| (position - middle).norm_squared() <= radius * radius;
        let inside = rest.positions.iter().enumerate().filter(|(_, position)| is_near(position));
        found.extend(inside.map(|(vertex, _)| vertex as u32));
        if found.is_empty() {
            let shown = format!("{near:?} with radius {radius:?}");
            return Err(Error::refuse(&joined(at, "near"), shown, "a ball with a vertex in it"));
        }
    }
    Ok(found)
}

/// The vertices of a named corner or edge.
fn named(name: &str, at: &str, rest: &RestMesh) -> Result<Vec<u32>> {
    let Some(grid) = &rest.grid else {
        let accepted = "names only for a grid; vertices, or near with radius, for a mesh";
        return Err(Error::refuse(at, format!("\"{name}\""), accepted));
    };
    grid.place(name).ok_or_else(|| Error::refuse(at, format!("\"{name}\""), &PLACES.join(", ")))
}
