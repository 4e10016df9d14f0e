//! The kernel against one spring after the other, and the same bits for any number of threads.

use boucle_geometry::{Mesh, Vector};
use pulp::{Arch, Simd, WithSimd};

use super::{BLOCK, CHUNK, Layout, Sums, add_from_inside, add_from_outside};
use crate::cloth::{Cloth, Mass};
use crate::law::spring::Law;
use crate::material::{DampingLaw, Limiter, SpringMaterial};
use crate::settings::{IntegratorKind, Settings};
use crate::simulation::Simulation;
use crate::state::State;

/// Numbers from -1 to 1 that look random (xorshift).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        for shift in [13, -7, 17] {
            self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
        }
        (self.0 >> 11) as f64 / f64::from(2.0f32).powi(52) - 1.0
    }

    fn below(&mut self, end: usize) -> usize {
        ((f64::midpoint(self.next(), 1.0) * end as f64) as usize).min(end - 1)
    }
}

/// A sheet of quads, some left out, its vertices in order or not.
fn sheet(
    columns: u32,
    rows: u32,
    holes: usize,
    is_shuffled: bool,
    material: SpringMaterial,
) -> Cloth {
    let mut noise = Noise(u64::from(columns * 31 + rows) | 1);
    let count = (columns * rows) as usize;
    let mut names: Vec<u32> = (0..count as u32).collect();
    if is_shuffled {
        (1..count).for_each(|i| names.swap(i, noise.below(i + 1)));
    }
    let at = |column: u32, row: u32| names[(row * columns + column) as usize];
    let mut faces: Vec<[u32; 4]> = (0..rows - 1)
        .flat_map(|row| (0..columns - 1).map(move |column| (column, row)))
        .map(|(c, r)| [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)])
        .collect();
    // A hole takes a face in the middle only: no vertex is left loose.
    for hole in 0..holes {
        faces.swap_remove((columns as usize + 2 + 7 * hole) % faces.len());
    }
    let mut positions = vec![Vector::zeros(); count];
    for i in 0..count as u32 {
        let jitter = 0.002 * noise.next();
        positions[names[i as usize] as usize] = Vector::new(
            0.02 * f64::from(i % columns) + jitter,
            0.005 * noise.next(),
            0.02 * f64::from(i / columns),
        );
    }
    let mesh = Mesh::from_faces(count, &faces).expect("a sheet");
    let pins = vec![at(0, rows - 1), at(columns - 1, rows - 1)];
    Cloth::from_mesh("sheet", mesh, positions, &Mass::Density(0.2), material, pins)
        .expect("a sound sheet")
}

fn material(damping: f64, damping_law: DampingLaw, limiter: Limiter) -> SpringMaterial {
    SpringMaterial { damping: [damping; 3], damping_law, limiter, ..SpringMaterial::default() }
}

/// Particles moved about, with velocities.
fn disturbed(cloths: &[Cloth]) -> State {
    let mut noise = Noise(99);
    let positions: Vec<Vector> = cloths.iter().flat_map(|cloth| cloth.positions.clone()).collect();
    let mut state = State::at_rest(&positions);
    for (axis, velocity) in state.position.0.iter_mut().zip(&mut state.velocity.0) {
        for (x, v) in axis.iter_mut().zip(velocity.iter_mut()) {
            *x += 0.01 * noise.next();
            *v = noise.next();
        }
    }
    state
}

/// The spring forces and, for scale, the sums of their sizes, one spring after the other.
fn one_by_one(cloths: &[Cloth], state: &State) -> (Vec<Vector>, Vec<f64>) {
    let mut forces = vec![Vector::zeros(); state.len()];
    let mut sizes = vec![0.0; state.len()];
    let mut base = 0;
    for cloth in cloths {
        let law = Law::of(cloth);
        for spring in &cloth.springs {
            let [a, b] = spring.ends.map(|end| base + end as usize);
            let span = state.position.get(a) - state.position.get(b);
            let velocity = state.velocity.get(a) - state.velocity.get(b);
            let length = span.norm();
            let direction = span / length;
            let stiffness = law.stiffness_at(spring.stiffness, length / spring.rest_length);
            let mut force = stiffness * (spring.rest_length - length) * direction;
            force -= spring.damping
                * match cloth.material.damping_law {
                    DampingLaw::Relative => velocity,
                    DampingLaw::Axial => velocity.dot(&direction) * direction,
                };
            forces[a] += force;
            forces[b] -= force;
            let size = stiffness * (spring.rest_length + length) + spring.damping * velocity.norm();
            sizes[a] += size;
            sizes[b] += size;
        }
        base += cloth.positions.len();
    }
    (forces, sizes)
}

/// The kernel's forces, with whatever instruction set runs it.
struct AllForces<'a> {
    layout: &'a Layout,
    state: &'a State,
}

impl WithSimd for AllForces<'_> {
    type Output = Vec<Vector>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<Vector> {
        let mut forces = Vec::new();
        for chunk in 0..self.state.len().div_ceil(CHUNK) {
            let mut sums = Sums::zeros();
            add_from_outside(simd, self.layout, chunk, self.state, &mut sums);
            let (first, end) = (chunk * CHUNK, ((chunk + 1) * CHUNK).min(self.state.len()));
            for start in (first..end).step_by(BLOCK) {
                let block = start..end.min(start + BLOCK);
                add_from_inside(simd, self.layout, chunk, &block, self.state, &mut sums);
                let force = |i: usize, axis: usize| sums.arriving[axis][i] - sums.leaving[axis][i];
                let places = block.start - first..block.end - first;
                forces.extend(places.map(|i| Vector::from_fn(|axis, _| force(i, axis))));
            }
        }
        forces
    }
}

fn agree(cloths: &[Cloth]) {
    let state = disturbed(cloths);
    let layout = &Layout::new(cloths);
    let state = &state;
    let forces = Arch::new().dispatch(AllForces { layout, state });
    let (expected, sizes) = one_by_one(cloths, state);
    assert_eq!(forces.len(), expected.len());
    for (particle, (force, expected)) in forces.iter().zip(&expected).enumerate() {
        let error = (force - expected).norm();
        assert!(error <= 1e-14 * sizes[particle], "{particle}: {force:?} is not {expected:?}");
    }
    let scalar = AllForces { layout, state }.with_simd(pulp::Scalar::new());
    assert_eq!(forces, scalar, "the bits depend on the instruction set");
}

#[test]
fn every_law_is_computed_on_diagonals_and_gathered() {
    for damping in [0.0, 0.01] {
        for law in [DampingLaw::Relative, DampingLaw::Axial] {
            for limiter in [Limiter::None, Limiter::Stiffen] {
                for is_shuffled in [false, true] {
                    agree(&[sheet(19, 13, 0, is_shuffled, material(damping, law, limiter))]);
                }
            }
        }
    }
}

#[test]
fn chunks_and_gaps_and_several_cloths_make_no_difference() {
    let damped = || material(0.01, DampingLaw::Relative, Limiter::None);
    let undamped = || material(0.0, DampingLaw::Axial, Limiter::None);
    let stiffening = || material(0.01, DampingLaw::Axial, Limiter::Stiffen);
    agree(&[sheet(64, 64, 0, false, damped())]);
    agree(&[sheet(61, 71, 40, false, damped())]);
    agree(&[sheet(61, 71, 3, true, stiffening())]);
    // Rows longer than a chunk: springs arrive from particles far before it.
    agree(&[sheet(CHUNK as u32 + 77, 4, 0, false, damped())]);
    agree(&[
        sheet(2, 2, 0, false, damped()),
        sheet(33, 40, 5, false, undamped()),
        sheet(30, 30, 0, true, damped()),
        sheet(5, 3, 0, false, stiffening()),
        sheet(50, 47, 11, false, damped()),
    ]);
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let damped = material(0.001, DampingLaw::Relative, Limiter::None);
    for (side, is_shuffled) in [(97, false), (49, true)] {
        let cloth = sheet(side, side, 0, is_shuffled, damped.clone());
        let hash = |threads: usize| {
            let settings = Settings {
                integrator: IntegratorKind::SymplecticEuler,
                threads,
                fps: 480.0,
                ..Settings::default()
            };
            let mut simulation = Simulation::new(vec![cloth.clone()], Vec::new(), settings)
                .expect("a sound simulation");
            for _ in 0..24 {
                simulation.advance().expect("a stable step");
            }
            simulation.certificate().hash
        };
        let one = hash(1);
        for threads in [2, 3, 4, 8] {
            assert_eq!(hash(threads), one, "{threads} threads");
        }
    }
}
