//! Time of contact detection: what one search for everything that touches takes, in milliseconds.
//!
//! Sheets with edges of one length and a thickness of a quarter of that, which collide with themselves: flat and at rest,
//! flat and falling unevenly, in folds that touch, and as they lie on a ball after having fallen on it.
//!
//! `cargo bench -p boucle-solver --bench contact [-- SIDE] [SHEET]`

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Collider, Collision, Detection, IntegratorKind, Mass, Settings, Shape, Simulation,
    SpringMaterial, StepSize,
};

const DETECTIONS: usize = 15;

/// Length (m) of an edge.
const EDGE: f64 = 0.01;

/// A sheet in motion, by its name and the vertices along its side.
type Scene = fn(u32, usize) -> Simulation;

fn main() {
    println!(
        "{:>8} {:>10} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9}",
        "vertices", "sheet", "threads", "fit ms", "search", "whole", "watched", "contacts"
    );
    let asked: Vec<String> = std::env::args().skip(1).filter(|each| each != "--bench").collect();
    let scenes: [(&str, Scene, &[u32]); 4] = [
        ("resting", resting, &[128, 512]),
        ("falling", falling, &[128, 512]),
        ("folded", folded, &[128, 512]),
        ("draped", draped, &[128]),
    ];
    for (name, scene, sides) in scenes {
        for &side in sides {
            let is_asked = |each: &String| *each == name || *each == side.to_string();
            for threads in [1, 2].into_iter().filter(|_| asked.iter().all(is_asked)) {
                row(name, side, threads, &mut scene(side, threads));
            }
        }
    }
}

fn row(name: &str, side: u32, threads: usize, simulation: &mut Simulation) {
    let detect = |_| {
        let detection = simulation.detect_contacts().expect("steps of the benchmark's own sheet");
        detection.expect("a sheet that touches itself")
    };
    let detections: Vec<Detection> = (0..DETECTIONS).map(detect).collect();
    let median = |time: fn(&Detection) -> std::time::Duration| {
        let mut times: Vec<_> = detections.iter().map(time).collect();
        times.sort_unstable();
        1e3 * times[DETECTIONS / 2].as_secs_f64()
    };
    println!(
        "{:>8} {name:>10} {threads:>7} {:>8.2} {:>8.2} {:>8.2} {:>9} {:>9}",
        side * side,
        median(|detection| detection.fit),
        median(|detection| detection.search),
        median(|detection| detection.whole),
        detections[0].watched,
        detections[0].contacts,
    );
}

fn resting(side: u32, threads: usize) -> Simulation {
    explicit(sheet(side), threads)
}

/// At 3 m/s, and up to 0.3 m/s more or less from vertex to vertex.
fn falling(side: u32, threads: usize) -> Simulation {
    let mut simulation = explicit(sheet(side), threads);
    let uneven = |vertex: u32| 0.3 * f64::from(vertex.wrapping_mul(2_654_435_769)).sin();
    let velocities: Vec<Vector> =
        (0..side * side).map(|vertex| Vector::new(0.0, 0.0, uneven(vertex) - 3.0)).collect();
    simulation.set_velocities(0, &velocities);
    simulation
}

/// Four layers, a little nearer to each other than their thickness.
fn folded(side: u32, threads: usize) -> Simulation {
    let length = f64::from(side) / 4.0 * EDGE;
    let fold = |x: &Vector| {
        let layer = (x.y / length).floor();
        let along = x.y - layer * length;
        let along = if layer % 2.0 == 0.0 { along } else { length - along };
        Vector::new(x.x + 0.3 * layer * EDGE, along, 0.45 * EDGE * (x.y / length))
    };
    let cloth = sheet(side);
    let positions: Vec<Vector> = cloth.positions.iter().map(fold).collect();
    let mut simulation = explicit(cloth, threads);
    simulation.set_positions(0, &positions);
    simulation
}

/// On a ball of a third of its width, after 24 frames.
fn draped(side: u32, threads: usize) -> Simulation {
    let width = f64::from(side) * EDGE;
    let radius = 0.3 * width;
    let ball = Collider {
        name: "ball".to_owned(),
        shape: Shape::Sphere { radius },
        positions: vec![Vector::new(0.5 * width, 0.5 * width, -radius - 0.02)],
        thickness: 0.25 * EDGE,
        friction: 0.3,
    };
    let settings = Settings { threads, perturbation: 1e-6, ..Settings::default() };
    let cloths = vec![sheet(side)];
    let mut simulation = Simulation::with_colliders(cloths, vec![ball], Vec::new(), settings)
        .expect("the benchmark's own sheet");
    for _ in 0..24 {
        simulation.advance().expect("a stable step");
    }
    simulation
}

/// A sheet alone, in 24 steps a frame: what moves it does not matter here.
fn explicit(cloth: Cloth, threads: usize) -> Simulation {
    let settings = Settings {
        integrator: IntegratorKind::SymplecticEuler,
        step_size: StepSize::Substeps(24),
        allow_unstable: true,
        threads,
        ..Settings::default()
    };
    Simulation::new(vec![cloth], Vec::new(), settings).expect("the benchmark's own sheet")
}

/// A flat square sheet of 0.2 kg/m².
fn sheet(side: u32) -> Cloth {
    let at = |column: u32, row: u32| row * side + column;
    let faces: Vec<[u32; 4]> = (0..side - 1)
        .flat_map(|row| (0..side - 1).map(move |column| (column, row)))
        .map(|(c, r)| [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)])
        .collect();
    let flat = |i: u32| EDGE * Vector::new(f64::from(i % side), f64::from(i / side), 0.0);
    let positions: Vec<Vector> = (0..side * side).map(flat).collect();
    let mesh = Mesh::from_faces((side * side) as usize, &faces).expect("a grid");
    let material = SpringMaterial::default();
    let mass = Mass::Density(0.2);
    let mut cloth = Cloth::from_mesh("sheet", mesh, positions, &mass, material, Vec::new())
        .expect("the benchmark's own sheet");
    cloth.collision = Some(Collision { thickness: 0.25 * EDGE, ..Collision::default() });
    cloth
}
