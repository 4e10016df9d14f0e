//! Creases and friction of bending against closed forms.

use super::tests::{assert_forces_are_the_slope, cloth, forces, sheet, uneven};
use super::*;
use crate::scatter::scattered;

/// B (N·m) of the sheets below.
const BEND: f64 = 2e-3;

/// Cells and jitter: of a grid and of a mesh without order, coarse and fine.
const MESHES: [(u32, f64); 4] = [(20, 0.0), (40, 0.0), (20, 0.3), (40, 0.3)];

/// A sheet (m) that only bends.
fn limp(cells: u32, jitter: f64, fabric: Fabric) -> (Fabrics, Vec<Vector>) {
    let (faces, positions) = sheet([cells; 2], [0.2; 2], jitter);
    let none = [0.0; 2];
    let fabric = Fabric { stretch: none, compression: none, shear: 0.0, bend: [BEND; 2], ..fabric };
    (Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, fabric)]), positions)
}

/// A sheet rolled onto a cylinder whose axis is turned by so many degrees.
fn rolled(positions: &[Vector], curvature: f64, degrees: f64) -> Vec<Vector> {
    let (s, c) = degrees.to_radians().sin_cos();
    let (across, along) = (Vector::new(c, s, 0.0), Vector::new(-s, c, 0.0));
    let middle = Vector::new(0.1, 0.1, 0.0);
    let roll = |x: &Vector| {
        let (angle, from) = (curvature * (x - middle).dot(&across), x - middle);
        let [out, up] = if curvature == 0.0 {
            [from.dot(&across), 0.0]
        } else {
            [angle.sin() / curvature, (1.0 - angle.cos()) / curvature]
        };
        out * across + from.dot(&along) * along + up * Vector::z()
    };
    positions.iter().map(roll).collect()
}

/// Half the square of the curvature (1/m²) that a rolled sheet still stores, as a part of that of a sheet without creases.
fn stored(fabrics: &Fabrics, state: &State) -> f64 {
    fabrics.energy(0..1, state) / (BEND * 0.04)
}

/// The curvature (1/m) of a cylinder to which a sheet is rolled at which its energy is least.
fn resting_curvature(fabrics: &Fabrics, positions: &[Vector], degrees: f64) -> f64 {
    // Energy is a parabola of the curvature, nearly: its top from three points.
    let at = |curvature| stored(fabrics, &State::at_rest(&rolled(positions, curvature, degrees)));
    let (mut middle, step) = (0.0, 0.5);
    for _ in 0..8 {
        let [a, b, c] = [at(middle - step), at(middle), at(middle + step)];
        middle += 0.5 * step * (a - c) / (a - 2.0 * b + c);
    }
    middle
}

/// Bends a sheet there and back, in so many steps.
fn bend(fabrics: &mut Fabrics, positions: &[Vector], [from, to]: [f64; 2], degrees: f64) {
    for step in 1..=40 {
        let curvature = from + (to - from) * f64::from(step) / 40.0;
        fabrics.give_way(&State::at_rest(&rolled(positions, curvature, degrees)));
    }
}

/// Bent to K, a sheet keeps `(1 - hardening) (K - yield_curvature)`. What lacks is what the polynomial leaves.
#[test]
fn a_sheet_keeps_the_curvature_that_plasticity_leaves_on_any_mesh() {
    let (limit, most) = (4.0, 10.0);
    for (hardening, expected) in [(0.0, 6.0), (0.25, 4.5)] {
        for (cells, jitter) in MESHES {
            for degrees in [0.0, 30.0, 45.0, 90.0] {
                let fabric =
                    Fabric { yield_curvature: Some(limit), hardening, ..Fabric::default() };
                let (mut fabrics, positions) = limp(cells, jitter, fabric);
                bend(&mut fabrics, &positions, [0.0, 0.7 * limit], degrees);
                let at = format!("{cells} cells, jitter {jitter}, {degrees}°, {hardening}");
                assert!(fabrics.creases().iter().all(|one| *one == Crease::default()), "{at}");
                bend(&mut fabrics, &positions, [0.7 * limit, most], degrees);
                let left = resting_curvature(&fabrics, &positions, degrees);
                let error = (left / expected - 1.0).abs();
                assert!(error < 0.02, "{at}: {left} beside {expected}");
            }
        }
    }
}

/// What is creased to 10 /m and straightened yields the other way, back to its bound.
#[test]
fn straightening_a_crease_takes_it_back_as_far_as_the_bound() {
    for (cells, jitter) in MESHES {
        let fabric = Fabric { yield_curvature: Some(4.0), ..Fabric::default() };
        let (mut fabrics, positions) = limp(cells, jitter, fabric);
        bend(&mut fabrics, &positions, [0.0, 10.0], 30.0);
        bend(&mut fabrics, &positions, [10.0, 0.0], 30.0);
        let left = resting_curvature(&fabrics, &positions, 30.0);
        assert!((left / 4.0 - 1.0).abs() < 0.02, "{cells} cells, jitter {jitter}: {left}");
    }
}

/// The moment by width (N·m/m) that holds a sheet on its cylinder: the work of its forces as the curvature grows.
fn moment(fabrics: &Fabrics, positions: &[Vector], curvature: f64, degrees: f64) -> f64 {
    let step = 1e-4;
    let [low, at, high] = [-step, 0.0, step].map(|by| rolled(positions, curvature + by, degrees));
    let forces = forces(fabrics, &State::at_rest(&at));
    let work: f64 =
        forces.iter().zip(low.iter().zip(&high)).map(|(f, (a, b))| f.dot(&(b - a))).sum();
    -work / (2.0 * step * 0.04)
}

/// A loop to 100 /m, back to -100 /m and again. Friction is of Prandtl's kind, so the loop is a parallelogram, of the area
/// `2HB (2 K - turn)`; as for any moment, a border of half a cell lacks, which the slope of the moment tells as well.
#[test]
fn the_loop_of_the_moment_is_as_wide_and_as_large_as_the_friction_says() {
    let width = 4e-2;
    let start = BEND + width / 50.0;
    for (cells, jitter) in MESHES {
        for degrees in [0.0, 45.0] {
            let fabric = Fabric { bend_hysteresis: width, ..Fabric::default() };
            let (mut fabrics, positions) = limp(cells, jitter, fabric);
            let mut moment_at = |curvature: i32| {
                let curvature = f64::from(curvature);
                fabrics.give_way(&State::at_rest(&rolled(&positions, curvature, degrees)));
                moment(&fabrics, &positions, curvature, degrees)
            };
            let first: Vec<f64> = (0..=100).map(&mut moment_at).collect();
            let down: Vec<f64> = (-100..=100).rev().map(&mut moment_at).collect();
            let up: Vec<f64> = (-100..=100).map(&mut moment_at).collect();
            let apart: Vec<f64> = up.iter().zip(down.iter().rev()).map(|(u, d)| u - d).collect();
            let area: f64 = apart.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum();
            let border = 1.8 / f64::from(cells);
            for (what, got, expected) in [
                ("slope at first", (first[15] - first[5]) / 10.0, start),
                ("slope", (up[120] - up[100]) / 20.0, BEND),
                ("width at 0", apart[100], width),
                ("width at -40 /m", apart[60], width),
                ("area", area, width * 150.0),
            ] {
                let lacks = 1.0 - got / expected;
                let at = format!("{cells} cells, jitter {jitter}, {degrees}°: {what}");
                assert!((-0.01..border).contains(&lacks), "{at} is {got:e}, not {expected:e}");
            }
        }
    }
}

/// A fabric that creases, hardens and rubs.
fn yielding() -> Fabric {
    Fabric { yield_curvature: Some(3.0), hardening: 0.3, bend_hysteresis: 0.05, ..uneven() }
}

/// A sheet with each particle moved at random by up to so many metres.
fn shaken(positions: &[Vector], size: f64, seed: u64) -> State {
    let shift =
        |i: usize| Vector::from_fn(|axis, _| size * scattered(seed + 3 * i as u64 + axis as u64));
    let moved: Vec<Vector> = positions.iter().enumerate().map(|(i, x)| x + shift(i)).collect();
    State::at_rest(&moved)
}

#[test]
fn giving_way_never_gains_energy() {
    let (faces, positions) = sheet([7, 6], [0.4, 0.3], 0.3);
    for (seed, fabric) in [
        yielding(),
        Fabric { hardening: 0.0, bend_hysteresis: 0.0, ..yielding() },
        Fabric { yield_curvature: None, ..yielding() },
        Fabric { yield_curvature: Some(0.0), bend: [0.0, 1e-3], ..yielding() },
    ]
    .into_iter()
    .enumerate()
    {
        let mut fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, fabric)]);
        let mut lost = 0.0;
        for round in 0..40_u64 {
            let state = shaken(&positions, 0.02, 1000 * round + 100_000 * seed as u64);
            let mut before = fabrics.energy(0..1, &state);
            for _ in 0..4 {
                fabrics.give_way(&state);
                let after = fabrics.energy(0..1, &state);
                assert!(after <= before * (1.0 + 1e-12), "{seed}: {before} J, then {after} J");
                lost += before - after;
                before = after;
            }
        }
        assert!(lost > 0.0, "{seed}");
    }
}

#[test]
fn forces_on_creased_cloth_are_the_slope_of_its_energy() {
    let (faces, positions) = sheet([4, 3], [0.4, 0.3], 0.2);
    let mut fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, yielding())]);
    for seed in 0..3 {
        fabrics.give_way(&shaken(&positions, 0.02, 100 * seed));
    }
    let state = shaken(&positions, 0.02, 900);
    assert_forces_are_the_slope(&fabrics, &state);
}

/// Faces between three pins do not bend, so nothing is left in them; where they are let go, what was left before is there.
#[test]
fn faces_that_are_pinned_keep_their_creases() {
    let (faces, positions) = sheet([6, 6], [0.3; 2], 0.0);
    let mut fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, yielding())]);
    fabrics.give_way(&shaken(&positions, 0.02, 0));
    let (creases, state) = (fabrics.creases().to_vec(), shaken(&positions, 0.02, 50));
    let before = forces(&fabrics, &state);
    fabrics.follow_pins(|_| true);
    fabrics.give_way(&shaken(&positions, 0.03, 100));
    assert_eq!(fabrics.creases(), creases);
    fabrics.follow_pins(|_| false);
    assert_eq!(forces(&fabrics, &state), before);
}

/// What a fabric does not say leaves everything as it was, beside another cloth that does.
#[test]
fn cloth_beside_a_creased_one_is_as_if_alone() {
    let (faces, positions) = sheet([5, 4], [0.3; 2], 0.2);
    let [plain, other] =
        [uneven(), yielding()].map(|one| cloth(&faces, positions.clone(), 0.2, one));
    let [alone, moved] = [0, 7].map(|seed| shaken(&positions, 0.02, seed));
    let both = |a: &State, b: &State| {
        let at =
            |state: &State| (0..state.len()).map(|i| state.position.get(i)).collect::<Vec<_>>();
        State::at_rest(&[at(a), at(b)].concat())
    };
    let mut two = Fabrics::new(&[plain.clone(), other]);
    two.give_way(&both(&moved, &moved));
    let mut one = Fabrics::new(&[plain]);
    one.give_way(&moved);
    assert!(one.creases().is_empty());
    let (expected, got) = (forces(&one, &alone), forces(&two, &both(&alone, &alone)));
    assert_eq!(got[..positions.len()], expected);
    assert_ne!(got[positions.len()..], expected);
}
