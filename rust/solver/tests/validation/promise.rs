//! The promise of the default settings: at no frame's end is an edge over the rate by more than 0.1 percentage points.
//!
//! Larger sheets take minutes: `cargo test --release -- --ignored promise`. The benchmark of the solver, `dev.py bench
//! solver`, checks the same on a sheet hung by two corners, up to 512².

use boucle_geometry::Vector;
use boucle_solver::IntegratorKind;

use crate::lying::{Hung, PROMISE, limited, lying_sheet, settings};
use crate::sheets::simulation;

/// A sheet that lies flat has fallen and snapped taut by then.
const FRAMES: u32 = 20;

/// Runs a sheet that lies flat and falls. If it sways, its pins move together by 0.3 m, once a second, at up to 2 m/s.
fn keeps_its_promise(side: u32, frames: u32, hung: Hung, sways: bool) {
    let rate = 0.05;
    let cloth = lying_sheet(side, hung, limited(rate));
    let rest = cloth.positions.clone();
    let mut sheet = simulation(cloth, settings(IntegratorKind::Bdf2));
    let mut worst = 0.0;
    for frame in 1..=frames {
        if sways {
            let phase = std::f64::consts::TAU * f64::from(frame) / 24.0;
            let sway = Vector::new(0.2, 1.0, 0.1) * (0.3 * phase.sin());
            let targets: Vec<Vector> = rest.iter().map(|at| at + sway).collect();
            sheet.set_pin_targets(0, &targets);
        }
        let over = sheet.advance().expect("a frame").max_strain - rate;
        assert!(over <= PROMISE, "{side}², {hung:?}, frame {frame}: {over} over {rate}");
        assert!(sheet.overstretched_edges(0).is_empty(), "{side}², {hung:?}, frame {frame}");
        worst = f64::max(worst, over);
    }
    // A sheet that never comes to its limit would prove nothing.
    assert!(worst > 0.0 || matches!(hung, Hung::Edge), "{side}², {hung:?}: {worst}");
}

#[test]
fn no_edge_of_128_squared_hung_by_a_corner_exceeds_the_rate() {
    keeps_its_promise(128, FRAMES, Hung::Corner, false);
}

#[test]
fn no_edge_of_128_squared_hung_by_two_corners_exceeds_the_rate() {
    keeps_its_promise(128, FRAMES, Hung::Corners, false);
}

#[test]
fn no_edge_of_128_squared_hung_by_an_edge_exceeds_the_rate() {
    keeps_its_promise(128, FRAMES, Hung::Edge, false);
}

/// Each of these frames takes about three times as long as without the sway.
#[test]
fn no_edge_of_128_squared_exceeds_the_rate_while_its_pins_sway() {
    keeps_its_promise(128, 14, Hung::Corners, true);
}

/// Every way to hang, one after the other.
fn keeps_its_promise_however_it_hangs(side: u32, frames: u32) {
    for hung in [Hung::Corner, Hung::Corners, Hung::Edge] {
        keeps_its_promise(side, frames, hung, false);
    }
    keeps_its_promise(side, frames, Hung::Corners, true);
}

#[test]
#[ignore = "minutes: cargo test --release -- --ignored promise"]
fn no_edge_of_128_squared_exceeds_the_rate_in_four_seconds() {
    keeps_its_promise_however_it_hangs(128, 96);
}

#[test]
#[ignore = "minutes: cargo test --release -- --ignored promise"]
fn no_edge_of_256_squared_exceeds_the_rate() {
    keeps_its_promise_however_it_hangs(256, 48);
}

#[test]
#[ignore = "minutes: cargo test --release -- --ignored promise"]
fn no_edge_of_512_squared_exceeds_the_rate() {
    keeps_its_promise_however_it_hangs(512, 24);
}
