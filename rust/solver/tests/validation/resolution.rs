//! The same cloth at any resolution: with stiffness of the continuum, unchanged settings give the same silhouette.

use boucle_solver::{IntegratorKind, Limiter, SpringMaterial, StiffnessFrom};

use crate::lying::{Hung, limited, lying_sheet, settings};
use crate::sheets::{run, simulation};

/// What may lie between two resolutions, relative.
const SAME: f64 = 0.03;

/// How the sheet looks.
#[derive(Clone, Copy, Debug)]
struct Look {
    /// Depth (m) of its lowest point below the pins, over the last second.
    bottom: f64,
    /// The same of the middle of its lower edge.
    sag: f64,
    /// Time (s) from the first to the third time that this middle passes below the pins.
    period: f64,
}

/// Five seconds of a sheet hung by two corners, from where it lies flat, with the default settings. Air damping of a
/// rate of 2 a second brings it to rest.
fn look(side: u32) -> Look {
    let (fps, seconds) = (24, 5);
    let air_damping = 2.0 * 0.8 / f64::from(side * side);
    let stiffness_from = StiffnessFrom::Continuum;
    let material = SpringMaterial { air_damping, stiffness_from, ..limited(0.05) };
    let cloth = lying_sheet(side, Hung::Corners, material);
    let pin = cloth.positions[(side * side - 1) as usize];
    let mut sheet = simulation(cloth, settings(IntegratorKind::Bdf2));
    let [left, right] = [(side - 1) / 2, side / 2].map(|column| column as usize);
    let path = (0..fps * seconds).map(|_| {
        run(&mut sheet, 1);
        let positions = sheet.positions(0);
        let lowest = positions.iter().map(|at| at.z).fold(f64::INFINITY, f64::min);
        (pin.z - lowest, pin - 0.5 * (positions[left] + positions[right]))
    });
    let path: Vec<_> = path.collect();
    let passes: Vec<f64> = path
        .windows(2)
        .enumerate()
        .filter_map(|(frame, two)| {
            let [before, after] = [two[0].1.y, two[1].1.y];
            let passes = before.signum() != after.signum();
            passes.then(|| (frame as f64 + before / (before - after)) / f64::from(fps))
        })
        .collect();
    assert!(passes.len() >= 3, "{side}²: it passes below its pins {} times", passes.len());
    let last = &path[path.len() - fps as usize..];
    let mean =
        |depth: &dyn Fn(usize) -> f64| (0..last.len()).map(depth).sum::<f64>() / last.len() as f64;
    Look {
        bottom: mean(&|frame| last[frame].0),
        sag: mean(&|frame| last[frame].1.z),
        period: passes[2] - passes[0],
    }
}

/// Holds coarser sheets to the look of a finer one, computed here.
fn assert_same_look(sides: &[u32], finest: u32) {
    let reference = look(finest);
    for &side in sides {
        let found = look(side);
        for (what, found, reference) in [
            ("bottom", found.bottom, reference.bottom),
            ("sag", found.sag, reference.sag),
            ("period", found.period, reference.period),
        ] {
            let difference = found / reference - 1.0;
            assert!(
                difference.abs() <= SAME,
                "{what} of {side}²: {found}, of {finest}²: {reference}, {difference:+.4}"
            );
        }
    }
}

#[test]
fn a_sheet_looks_the_same_at_32_as_at_64_squared() {
    assert_same_look(&[32], 64);
}

#[test]
#[ignore = "minutes: cargo test --release -- --ignored resolution"]
fn a_sheet_looks_the_same_at_32_and_64_as_at_128_squared() {
    assert_same_look(&[32, 64], 128);
}

#[test]
#[ignore = "minutes: cargo test --release -- --ignored resolution"]
fn a_sheet_looks_the_same_at_every_resolution_as_at_256_squared() {
    assert_same_look(&[32, 64, 128], 256);
}

/// With stiffness of the continuum, the same settings give the same shape on any mesh.
#[test]
fn a_sheet_hangs_as_low_at_every_resolution() {
    let material = SpringMaterial {
        stiffness: [400.0, 200.0, 4.0],
        stiffness_from: StiffnessFrom::Continuum,
        limiter: Limiter::None,
        ..SpringMaterial::default()
    };
    let lowest = [16, 32].map(|side| {
        // A rate of 1 a second, for particles of 0.8 kg in all.
        let air_damping = 0.8 / f64::from(side * side);
        let material = SpringMaterial { air_damping, ..material.clone() };
        let mut sheet = simulation(
            lying_sheet(side, Hung::Edge, material),
            settings(IntegratorKind::ImplicitEuler),
        );
        run(&mut sheet, 240);
        let heights = sheet.positions(0);
        heights.iter().map(|position| position.z).fold(f64::INFINITY, f64::min)
    });
    let difference = lowest[0] / lowest[1] - 1.0;
    assert!(difference.abs() < 0.03, "{lowest:?}");
}
