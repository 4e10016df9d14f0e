//! What a frame can be held to: strain, energy and a hash of every position bit.

use xxhash_rust::xxh3::Xxh3;

use crate::cloth::Placed;
use crate::law::spring::Law;
use crate::material::SpringKind;
use crate::sewing::energy;
use crate::state::State;
use crate::system::System;

/// The certificate of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// The frame it belongs to.
    pub frame: i32,
    /// Steps that led here from the frame before; 0 at rest.
    pub substeps: u32,
    /// Iterations of the linear solver over those steps; 0 for explicit integrators.
    pub iterations: u32,
    /// Largest elongation `L/L0 - 1` over mesh edges (stretch springs).
    pub max_strain: f64,
    /// 99th percentile of the same.
    pub p99_strain: f64,
    /// Largest elongation over shear springs.
    pub max_shear_strain: f64,
    /// Intersections of edges with triangles, exactly: cloths with themselves, with each other and with colliders, as far
    /// as they collide; `None` if nothing does.
    pub intersections: Option<u64>,
    /// Vertices whose motion was cut short by contact, once for each step.
    pub clipped: u32,
    /// Contacts at the end of the frame.
    pub contacts: u32,
    /// Kinetic energy (J).
    pub kinetic_energy: f64,
    /// Energy of springs and of height (J).
    pub potential_energy: f64,
    /// XXH3-64 over all positions, f64 little-endian, cloth by cloth.
    pub hash: u64,
}

/// The certificate of a state.
pub(crate) fn certify<'a>(
    cloths: impl Iterator<Item = Placed<'a>> + Clone,
    state: &State,
    system: &System,
    frame: i32,
    substeps: u32,
) -> Certificate {
    let mut stretch = strains(cloths.clone(), state, SpringKind::Stretch);
    let shear = strains(cloths.clone(), state, SpringKind::Shear);
    let (kinetic_energy, potential_energy) = energies(cloths.clone(), state, system);
    Certificate {
        frame,
        substeps,
        iterations: 0,
        max_strain: stretch.iter().copied().fold(f64::NEG_INFINITY, f64::max).max(-1.0),
        p99_strain: percentile(&mut stretch, 0.99),
        max_shear_strain: shear.iter().copied().fold(f64::NEG_INFINITY, f64::max).max(-1.0),
        intersections: None,
        clipped: 0,
        contacts: 0,
        kinetic_energy,
        potential_energy,
        hash: hash(cloths, state),
    }
}

fn strains<'a>(
    cloths: impl Iterator<Item = Placed<'a>>,
    state: &State,
    kind: SpringKind,
) -> Vec<f64> {
    cloths
        .flat_map(|(cloth, base)| {
            let springs = cloth.springs.iter().filter(move |spring| spring.kind == kind);
            springs.map(move |spring| length(state, spring.ends, base) / spring.rest_length - 1.0)
        })
        .collect()
}

/// Present distance (m) between two particles of a cloth.
pub(crate) fn length(state: &State, [a, b]: [u32; 2], base: u32) -> f64 {
    state.position.distance_squared(base + a, base + b).sqrt()
}

/// The value that a part of the values does not exceed; 0 of none.
fn percentile(values: &mut [f64], part: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let rank = (part * (values.len() - 1) as f64).ceil() as usize;
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// Kinetic and potential energy (J). What equation 6 stores in a stiffened spring is the integral of its force.
fn energies<'a>(
    cloths: impl Iterator<Item = Placed<'a>>,
    state: &State,
    system: &System,
) -> (f64, f64) {
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for (cloth, base) in cloths {
        let law = Law::of(cloth);
        for particle in base as usize..base as usize + cloth.masses.len() {
            let mass = system.masses[particle];
            kinetic += 0.5 * mass * state.velocity.get(particle).norm_squared();
            potential -= mass * system.gravity.dot(&state.position.get(particle));
        }
        let force_max = cloth.tailoring.sewing.as_ref().map_or(0.0, |sewing| sewing.force_max);
        for spring in &cloth.springs {
            if spring.kind == SpringKind::Sewing {
                potential += energy(spring.stiffness, force_max, length(state, spring.ends, base));
                continue;
            }
            let ratio = length(state, spring.ends, base) / spring.rest_length;
            potential += spring.stiffness * spring.rest_length.powi(2) * law.energy(ratio);
        }
    }
    (kinetic, potential)
}

fn hash<'a>(cloths: impl Iterator<Item = Placed<'a>>, state: &State) -> u64 {
    let mut hasher = Xxh3::new();
    for (cloth, base) in cloths {
        for particle in base as usize..base as usize + cloth.positions.len() {
            for axis in &state.position.0 {
                hasher.update(&axis[particle].to_le_bytes());
            }
        }
    }
    hasher.digest()
}
