//! Time of the explicit kernel: nanoseconds for each spring, step and core, and the limiters' share.
//!
//! `cargo bench -p boucle-solver --bench explicit [-- SIDE]`

use std::time::Instant;

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, IntegratorKind, Limiter, Mass, Settings, Simulation, SpringMaterial, StepSize,
};

const SUBSTEPS: u32 = 200;
const FRAMES: usize = 7;

fn main() {
    println!(
        "{:>6} {:>8} {:>18} {:>8} {:>12} {:>14}",
        "side", "threads", "limiter", "damped", "us/step", "ns/spring/core"
    );
    let only = std::env::args().skip(1).find_map(|argument| argument.parse::<u32>().ok());
    for side in [32, 64, 128, 256].into_iter().filter(|&side| only.is_none_or(|only| only == side))
    {
        for threads in [1, 2] {
            for (limiter, is_damped) in [
                (Limiter::None, false),
                (Limiter::None, true),
                (Limiter::Stiffen, true),
                (Limiter::Provot, true),
                (Limiter::Project, true),
            ] {
                row(side, threads, limiter, is_damped);
            }
        }
    }
}

fn row(side: u32, threads: usize, limiter: Limiter, is_damped: bool) {
    let material = SpringMaterial {
        damping: if is_damped { [1e-3; 3] } else { [0.0; 3] },
        limiter,
        ..SpringMaterial::default()
    };
    let cloth = sheet(side, material);
    let springs = cloth.springs.len();
    let settings = Settings {
        integrator: IntegratorKind::SymplecticEuler,
        step_size: StepSize::Substeps(SUBSTEPS),
        fps: 48.0,
        allow_unstable: true,
        threads,
        ..Settings::default()
    };
    let mut simulation =
        Simulation::new(vec![cloth], Vec::new(), settings).expect("the benchmark's own sheet");
    let mut seconds = Vec::new();
    for _ in 0..FRAMES {
        let start = Instant::now();
        if let Err(error) = simulation.advance() {
            println!("{side:>6} {threads:>8} {limiter:>18?} {is_damped:>8} {error}");
            return;
        }
        seconds.push(start.elapsed().as_secs_f64() / f64::from(SUBSTEPS));
    }
    seconds.sort_by(f64::total_cmp);
    let median = seconds[FRAMES / 2];
    let each = 1e9 * median * threads as f64 / springs as f64;
    let limiter = format!("{limiter:?}");
    println!(
        "{side:>6} {threads:>8} {limiter:>18} {is_damped:>8} {:>12.1} {each:>14.3}",
        1e6 * median
    );
}

/// A sheet of 2 m x 2 m and 0.2 kg/m², hung by two corners.
fn sheet(side: u32, material: SpringMaterial) -> Cloth {
    let at = |column: u32, row: u32| row * side + column;
    let faces: Vec<[u32; 4]> = (0..side - 1)
        .flat_map(|row| (0..side - 1).map(move |column| (column, row)))
        .map(|(c, r)| [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)])
        .collect();
    let spacing = 2.0 / f64::from(side - 1);
    let positions = (0..side * side)
        .map(|i| Vector::new(f64::from(i % side) * spacing, 0.0, f64::from(i / side) * spacing))
        .collect();
    let mesh = Mesh::from_faces((side * side) as usize, &faces).expect("a grid");
    let pins = vec![at(0, side - 1), at(side - 1, side - 1)];
    Cloth::from_mesh("sheet", mesh, positions, &Mass::Density(0.2), material, pins)
        .expect("the benchmark's own sheet")
}
