//! Scenes that every engine of cloth shows, in a small size: no frame has an intersection, nothing is lost, and no edge is
//! longer than its deformation rate allows.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Collider, IntegratorKind, Mass, Settings, Shape, Simulation, SpringMaterial,
};
use nalgebra::Rotation3;

use crate::contact_things::{
    among, ball, collider, colliding, corners, floor, lathe, patch, placed, sound_frame,
};

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 2, ..Settings::default() }
}

fn bdf2() -> Settings {
    settings(IntegratorKind::Bdf2)
}

fn springs(bend: f64) -> SpringMaterial {
    SpringMaterial { stiffness: [500.0, 100.0, bend], ..SpringMaterial::default() }
}

/// A square sheet of so many vertices and meters a side at a height (m), that keeps a quarter of its edges.
fn sheet(side: u32, width: f64, middle: Vector, bend: f64) -> Cloth {
    let cloth = placed(patch([side, side], width, springs(bend)), |x| x + middle);
    colliding(cloth, 0.25 * width / f64::from(side - 1), 0.3)
}

/// Runs so many sound frames, before each of which `act` may move things; something must have touched.
#[track_caller]
fn is_sound(
    what: &str,
    mut simulation: Simulation,
    frames: u32,
    act: impl Fn(&mut Simulation),
) -> Simulation {
    assert_eq!(simulation.certificate().intersections, Some(0), "{what}: at the start");
    let mut contacts = 0;
    for _ in 0..frames {
        act(&mut simulation);
        contacts += sound_frame(what, &mut simulation).contacts;
    }
    assert!(contacts > 0, "{what}: nothing has touched");
    simulation
}

fn nothing(_: &mut Simulation) {}

/// Sends a collider along a way (m) from where it was at first.
fn carry(simulation: &mut Simulation, number: usize, way: &Vector) {
    let places = &simulation.collider(number).positions;
    let targets: Vec<Vector> = places.iter().map(|x| x + way).collect();
    simulation.set_collider_targets(number, &targets).expect("as many targets");
}

/// At most 30 steps: those of explicit rules are refused where they are not stable.
#[test]
fn a_sheet_drops_on_a_ball_and_on_a_floor_without_intersections_by_every_rule() {
    for integrator in IntegratorKind::ALL {
        // Forward Euler and midpoint need damping to be stable at all.
        let material = SpringMaterial {
            damping: [0.05, 0.02, 0.01],
            stiffness: [100.0, 20.0, 1.0],
            ..SpringMaterial::default()
        };
        for (what, obstacle, height) in
            [("ball", ball(Vector::zeros(), 0.2, 0.3), 0.23), ("floor", floor(0.3), 0.04)]
        {
            let cloth = placed(patch([16, 16], 0.6, material.clone()), |x| {
                Vector::new(x.x, x.y, x.z + height + 0.05 * x.x)
            });
            let cloth = colliding(cloth, 0.01, 0.3);
            let simulation = among(vec![cloth], vec![obstacle], settings(integrator));
            is_sound(&format!("{what}, {integrator:?}"), simulation, 16, nothing);
        }
    }
}

#[test]
fn a_sheet_drops_on_a_ball_and_hangs_down_around_it() {
    let sheet = sheet(24, 1.5, 0.42 * Vector::z(), 5.0);
    let simulation = among(vec![sheet], vec![ball(Vector::zeros(), 0.375, 0.3)], bdf2());
    let simulation = is_sound("ball", simulation, 36, nothing);
    let lowest = simulation.positions(0).iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    assert!(lowest < -0.2, "it hangs down to {lowest} m");
}

#[test]
fn a_sheet_drops_on_the_corner_of_a_box() {
    let upright = Rotation3::from_axis_angle(&Vector::y_axis(), -(0.5_f64).sqrt().atan())
        * Rotation3::from_axis_angle(&Vector::x_axis(), std::f64::consts::FRAC_PI_4);
    let places: Vec<Vector> =
        corners(Vector::zeros(), Vector::repeat(0.6)).iter().map(|x| upright * x).collect();
    let top = places.iter().map(|x| x.z).fold(0.0, f64::max);
    assert!((top - 0.5196).abs() < 1e-3, "a corner points up: {top}");
    let sheet = sheet(24, 1.5, 0.65 * Vector::z(), 5.0);
    let corner = collider(Shape::cuboid(), places, 0.3);
    is_sound("corner", among(vec![sheet], vec![corner], bdf2()), 36, nothing);
}

/// Cones with 6 sides, 0.3 m high and 3 cm thick, 0.2 m apart.
fn needles() -> Collider {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for needle in 0..25_u32 {
        let first = 7 * needle;
        let foot = Vector::new(f64::from(needle / 5) - 2.0, f64::from(needle % 5) - 2.0, 0.0) * 0.2;
        for side in 0..6_u32 {
            let angle = std::f64::consts::TAU * f64::from(side) / 6.0;
            positions.push(foot + 0.015 * Vector::new(angle.cos(), angle.sin(), 0.0));
            faces.push([first + side, first + (side + 1) % 6, first + 6]);
        }
        positions.push(foot + 0.3 * Vector::z());
    }
    let mesh = Mesh::from_faces(positions.len(), &faces).expect("cones");
    collider(Shape::Mesh(mesh), positions, 0.3)
}

#[test]
fn a_sheet_of_30_m_per_s_is_not_pierced_by_needles() {
    let sheet = sheet(24, 1.2, Vector::new(0.013, 0.007, 0.6), 5.0);
    let mut simulation = among(vec![sheet], vec![needles(), floor(0.3)], bdf2());
    simulation.set_velocities(0, &[-30.0 * Vector::z(); 24 * 24]);
    is_sound("needles", simulation, 12, nothing);
}

#[test]
fn a_strip_that_falls_end_on_folds_into_a_stack() {
    let lean = Rotation3::from_axis_angle(&Vector::x_axis(), 1.0_f64.to_radians());
    let upright = |x: &Vector| lean * Vector::new(x.x, 0.0, x.y) + 0.55 * Vector::z();
    let strip = placed(patch([4, 31], 0.1, springs(1.0)), upright);
    let strip = colliding(strip, 0.008, 0.5);
    is_sound("strip", among(vec![strip], vec![floor(0.5)], bdf2()), 36, nothing);
}

#[test]
fn a_sheet_falls_on_another() {
    let turn = Rotation3::from_axis_angle(&Vector::z_axis(), std::f64::consts::FRAC_PI_4);
    let lower =
        Cloth { pins: vec![0, 21, 21 * 22, 22 * 22 - 1], ..sheet(22, 1.4, Vector::zeros(), 5.0) };
    let upper = placed(sheet(16, 1.0, Vector::zeros(), 5.0), |x| turn * x + 0.15 * Vector::z());
    is_sound("two sheets", among(vec![lower, upper], Vec::new(), bdf2()), 24, nothing);
}

/// A tube of cloth, one rim of which turns by 30° a frame and comes nearer by 0.0067 m.
#[test]
fn a_tube_is_twisted_like_a_rope() {
    let (sides, rows) = (16_u32, 17_u32);
    let profile: Vec<[f64; 2]> = (0..rows).map(|row| [0.15, f64::from(row) / 16.0 - 0.5]).collect();
    let (mesh, positions) = lathe(sides, &profile);
    let top = (rows - 1) * sides;
    let pins: Vec<u32> = (0..sides).chain(top..top + sides).collect();
    let mass = Mass::Density(0.2);
    let tube = Cloth::from_mesh("tube", mesh, positions.clone(), &mass, springs(1.0), pins)
        .expect("a tube");
    let tube = colliding(tube, 0.008, 0.3);
    let weightless = Settings { gravity: Vector::zeros(), ..bdf2() };
    is_sound("twist", among(vec![tube], Vec::new(), weightless), 24, |simulation| {
        let turns = f64::from(simulation.frame());
        let turn = Rotation3::from_axis_angle(&Vector::z_axis(), (30.0 * turns).to_radians());
        let nearer = -0.01 * turns * Vector::z();
        let targets: Vec<Vector> = positions
            .iter()
            .enumerate()
            .map(|(i, x)| if i as u32 >= top { turn * x + nearer } else { *x })
            .collect();
        simulation.set_pin_targets(0, &targets);
    });
}

#[test]
fn a_sheet_falls_into_a_funnel_thin_as_paper() {
    let profile = [[0.12, -0.4], [0.12, -0.2], [0.12, 0.0], [0.36, 0.25], [0.6, 0.5]];
    let (mesh, positions) = lathe(24, &profile);
    let funnel = collider(Shape::Mesh(mesh), positions, 0.1);
    let sheet = sheet(20, 1.0, Vector::new(0.05, 0.02, 0.6), 1.0);
    is_sound("funnel", among(vec![sheet], vec![funnel], bdf2()), 30, nothing);
}

#[test]
fn a_table_cloth_is_pulled_from_its_table() {
    let side = 20;
    let pins: Vec<u32> = (0..side).map(|row| row * side + side - 1).collect();
    let cloth = sheet(side, 1.3, 0.02 * Vector::z(), 5.0);
    let cloth = Cloth { pins, ..colliding(cloth, 0.014, 0.2) };
    let rest = cloth.positions.clone();
    let places = corners(Vector::new(0.0, 0.0, -0.2), Vector::new(1.0, 1.0, 0.4));
    let table = collider(Shape::cuboid(), places, 0.2);
    is_sound("table-cloth", among(vec![cloth], vec![table], bdf2()), 30, |simulation| {
        let pulled = (f64::from(simulation.frame()) - 8.0).clamp(0.0, 12.0) / 12.0;
        let targets: Vec<Vector> = rest.iter().map(|x| x + 2.0 * pulled * Vector::x()).collect();
        simulation.set_pin_targets(0, &targets);
    });
}

/// To three times the thickness, where flat cloth has room, and open again.
#[test]
fn two_plates_close_on_a_sheet_that_lies_askew() {
    let askew = Rotation3::from_axis_angle(&Vector::x_axis(), 8.0_f64.to_radians());
    let cloth = placed(patch([20, 20], 1.0, springs(5.0)), |x| askew * x + 0.12 * Vector::z());
    let cloth = colliding(cloth, 0.01, 0.3);
    let size = Vector::new(1.4, 1.4, 0.1);
    let plates =
        [-0.05, 0.35].map(|z| collider(Shape::cuboid(), corners(z * Vector::z(), size), 0.3));
    is_sound("plates", among(vec![cloth], plates.to_vec(), bdf2()), 30, |simulation| {
        let frame = f64::from(simulation.frame());
        let closed = (frame / 15.0).min((30.0 - frame) / 10.0).clamp(0.0, 1.0);
        carry(simulation, 1, &(-0.27 * closed * Vector::z()));
    });
}

#[test]
fn twelve_layers_fall_on_each_other_and_do_not_bounce() {
    let layer = |number: u32| {
        let height = 0.01 * f64::from(number + 1);
        let cloth = placed(patch([8, 8], 0.2, springs(5.0)), |x| x + height * Vector::z());
        colliding(cloth, 0.0045, 0.3)
    };
    let simulation = among((0..12).map(layer).collect(), vec![floor(0.3)], bdf2());
    let simulation = is_sound("layers", simulation, 25, |simulation| {
        let highest = simulation.positions(11).iter().map(|x| x.z).fold(0.0, f64::max);
        assert!(highest < 0.125, "the pile of 0.12 m reaches {highest} m");
    });
    let heights: Vec<f64> =
        (0..12).map(|cloth| crate::contact_things::mean(&simulation.positions(cloth)).z).collect();
    assert!(heights.is_sorted(), "the layers have changed places: {heights:?}");
}

/// 2.5 m a frame: it must take the sheet along, not pass through it. The sheet starts behind the ball's way and ends ahead
/// of the ball.
#[test]
fn a_ball_of_60_m_per_s_does_not_pass_through_a_pinned_sheet() {
    let upright = |x: &Vector| Vector::new(x.x, 0.0, x.y);
    let sheet = placed(sheet(24, 2.0, Vector::zeros(), 5.0), upright);
    let sheet = Cloth { pins: vec![23 * 24, 24 * 24 - 1], ..sheet };
    let thrown = ball(Vector::new(0.1, -4.0, -0.3), 0.3, 0.3);
    let mut simulation = among(vec![sheet], vec![thrown], bdf2());
    for frame in 0..10 {
        carry(&mut simulation, 0, &(2.5 * f64::from(frame + 1) * Vector::y()));
        let certificate = simulation.advance().expect("a frame");
        assert_eq!(certificate.intersections, Some(0), "frame {}", certificate.frame);
        let is_finite = simulation.positions(0).iter().flatten().all(|x| x.is_finite());
        assert!(is_finite, "frame {}", certificate.frame);
    }
}

/// A ball of triangles that sways and breathes.
#[test]
fn a_sheet_falls_on_a_body_that_moves_and_deforms() {
    let rings: Vec<[f64; 2]> = (0..=10)
        .map(|ring| {
            let angle = std::f64::consts::PI * (f64::from(ring) / 10.0 - 0.5) * 0.999;
            [0.4 * angle.cos(), 0.4 * angle.sin()]
        })
        .collect();
    let (mesh, positions) = lathe(16, &rings);
    let body = collider(Shape::Mesh(mesh), positions.clone(), 0.5);
    let sheet = sheet(20, 1.4, 0.5 * Vector::z(), 5.0);
    is_sound("body", among(vec![sheet], vec![body], bdf2()), 30, |simulation| {
        let seconds = f64::from(simulation.frame()) / 24.0;
        let breath = 1.0 + 0.15 * (std::f64::consts::TAU * seconds).sin();
        let lean = 0.5 * (std::f64::consts::PI * seconds).sin();
        let targets: Vec<Vector> = positions
            .iter()
            .map(|x| Vector::new(x.x * breath + lean * x.z, x.y * breath, x.z))
            .collect();
        simulation.set_collider_targets(0, &targets).expect("as many targets");
    });
}
