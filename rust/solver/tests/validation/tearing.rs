//! Cloth that tears: at the load that it bears, along the edge that is weakest, and what the pieces do.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Collision, Fabric, Flow, IntegratorKind, Limiter, Mass, Opening, Settings, Sewing,
    Simulation, SpringMaterial, StiffnessFrom, Tear, Warp, Wind, WindLaw,
};

use crate::sheets::{grid_mesh, in_wind, material, run, sheet};

const COLUMNS: u32 = 7;
const ROWS: u32 = 13;
const SPACING: f64 = 0.05;
/// kg
const EACH: f64 = 0.002;

/// A sheet that hangs from its top row, weak across the middle. Its rows number upward.
fn hanging(mass: &Mass, material: SpringMaterial, tear: Tear) -> Cloth {
    let top: Vec<u32> = (COLUMNS * (ROWS - 1)..COLUMNS * ROWS).collect();
    let cloth = sheet([COLUMNS, ROWS], SPACING, mass, material, &top);
    let upright = |x: &Vector| Vector::new(x.x, 0.0, x.y);
    let positions = cloth.positions.iter().map(upright).collect();
    Cloth { positions, tear: Some(tear), ..cloth }
}

fn weak_at(row: u32, strength: f64) -> Vec<f64> {
    (0..COLUMNS * ROWS).map(|i| if i / COLUMNS == row { strength } else { 1.0 }).collect()
}

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 1, perturbation: 0.0, ..Settings::default() }
}

/// Gravity grows until the sheet tears; returns how large it is then (m/s²).
fn load_until_torn(simulation: &mut Simulation, growth: f64) -> f64 {
    for frame in 1..2000 {
        let g = growth * f64::from(frame);
        simulation.set_gravity(Vector::z() * -g).expect("accepted");
        run(simulation, 1);
        if !simulation.torn_edges(0).is_empty() {
            return g;
        }
    }
    panic!("it never tore");
}

/// Each column bears its own weight: the edge above row r pulls with m g (r + 1). That above the weak row is the first to break.
#[test]
fn a_sheet_under_a_growing_load_tears_at_its_force_along_its_weakest_row() {
    let (force, weak, row) = (10.0, 0.15, 6);
    for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::SymplecticEuler] {
        let damped = SpringMaterial { air_damping: 0.02, ..material([4000.0, 0.0, 0.0]) };
        let tear = Tear { force: Some(force), strength: weak_at(row, weak), ..Tear::default() };
        let mut simulation = in_wind(
            hanging(&Mass::PerVertex(EACH), damped, tear),
            Vec::new(),
            settings(integrator),
        );
        let g = load_until_torn(&mut simulation, 0.5);
        let expected = weak * force / (EACH * f64::from(row + 1));
        assert!((g / expected - 1.0).abs() < 0.03, "{integrator:?}: {g} beside {expected}");
        run(&mut simulation, 3);
        let torn = simulation.torn_edges(0);
        let is_across = |[a, b]: &[u32; 2]| a / COLUMNS == row && b / COLUMNS == row;
        assert_eq!(torn.len(), COLUMNS as usize - 1, "{torn:?}");
        assert!(torn.iter().all(is_across), "{torn:?}");
    }
}

/// The membrane stress at the weak row is what hangs below it, over the width.
#[test]
fn fabric_under_a_growing_load_tears_at_its_force_along_its_weakest_row() {
    let (force, weak, row) = (10.0, 0.15, 6);
    let density = 0.8;
    let damped = SpringMaterial { air_damping: 0.02, ..material([0.0; 3]) };
    let tear = Tear { force: Some(force), strength: weak_at(row, weak), ..Tear::default() };
    let cloth =
        hanging(&Mass::Density(density), damped, tear).of_fabric(fabric()).expect("a fabric");
    let mut simulation = in_wind(cloth, Vec::new(), settings(IntegratorKind::ImplicitEuler));
    let g = load_until_torn(&mut simulation, 0.5);
    // The triangles above a row carry all below and half of its cells; the width of one is that of a cell.
    let below = density * SPACING * (f64::from(row) + 0.5);
    let expected = weak * force / (below * SPACING);
    assert!((g / expected - 1.0).abs() < 0.03, "{g} beside {expected}");
    run(&mut simulation, 3);
    let torn = simulation.torn_edges(0);
    assert!(torn.iter().all(|[a, b]| a / COLUMNS == row && b / COLUMNS == row), "{torn:?}");
    assert_eq!(torn.len(), COLUMNS as usize - 1);
}

/// A sheet of 0.3 x 0.6 m and 0.8 kg/m² that hangs, so many cells wide, bears 40 N/m, and is weak across its middle by a factor.
fn hung(cells: u32, weak: f64, stiffness: [f64; 3], stiffness_from: StiffnessFrom) -> Cloth {
    let spacing = 0.3 / f64::from(cells);
    let (columns, rows) = (cells + 1, 2 * cells + 1);
    let top: Vec<u32> = (columns * (rows - 1)..columns * rows).collect();
    let strength = (0..columns * rows).map(|v| if v / columns == cells { weak } else { 1.0 });
    let tear = Tear { stress: Some(40.0), strength: strength.collect(), ..Tear::default() };
    // About half of the critical damping of a vertex that swings as the sheet does, at 29 Hz: a load that grows frame by
    // frame, at 24 Hz, would make it ring.
    let material = SpringMaterial {
        air_damping: 100.0 * spacing * spacing,
        stiffness_from,
        ..material(stiffness)
    };
    let cloth = sheet([columns, rows], spacing, &Mass::Density(0.8), material, &top);
    let upright = |x: &Vector| Vector::new(x.x, 0.0, x.y);
    let positions = cloth.positions.iter().map(upright).collect();
    Cloth { positions, tear: Some(tear), ..cloth }
}

/// It tears at the stress that it bears: `expected` is gravity (m/s²) then.
fn tears_at(expected: f64, name: &str, cloth: Cloth) {
    let mut simulation = in_wind(cloth, Vec::new(), settings(IntegratorKind::ImplicitEuler));
    let g = load_until_torn(&mut simulation, 0.5);
    println!("{name}: {g} m/s2 beside {expected}");
    assert!((g / expected - 1.0).abs() < 0.03, "{name}: {g} beside {expected}");
}

fn fabric() -> Fabric {
    Fabric {
        stretch: [4000.0; 2],
        shear: 1000.0,
        warp: Warp::Along(Vector::z()),
        ..Fabric::default()
    }
}

/// Hung up, a sheet tears where its weight over its width is the stress that it bears, whatever its mesh and model. Shear springs
/// would make it narrower as it gets longer, and its corners bear more where it is held.
#[test]
fn a_sheet_tears_at_the_same_stress_at_any_resolution() {
    let stiffness = [4000.0, 0.0, 0.0];
    for cells in [3, 6, 12] {
        let of = |from| hung(cells, 1.0, stiffness, from);
        // What the topmost edges carry, and those triangles.
        let expected = 40.0 / (0.8 * (0.6 - 0.15 / f64::from(cells)));
        tears_at(expected, &format!("membrane of {cells} cells"), of(StiffnessFrom::Continuum));
        tears_at(expected, &format!("springs of {cells} cells"), of(StiffnessFrom::Springs));
        let of_fabric = of(StiffnessFrom::Springs).of_fabric(fabric()).expect("a fabric");
        tears_at(expected, &format!("fabric of {cells} cells"), of_fabric);
    }
}

/// The same far from what holds it, where shear and bend springs bear a part.
#[test]
fn a_sheet_tears_at_the_same_stress_whatever_part_of_it_shear_springs_bear() {
    for cells in [3, 6, 12] {
        let expected = 0.4 * 40.0 / (0.8 * (0.3 + 0.15 / f64::from(cells)));
        for shear in [400.0, 800.0] {
            let stiffness = [4000.0, shear, 50.0];
            let name = format!("shear {shear}, {cells} cells");
            tears_at(expected, &name, hung(cells, 0.4, stiffness, StiffnessFrom::Continuum));
        }
    }
}

/// The edges across a row of cells carry all that hangs below it, whatever part of it shear and bend springs bear.
#[test]
fn the_edges_of_a_row_carry_all_below_it() {
    for stiffness in [[4000.0, 0.0, 0.0], [4000.0, 800.0, 100.0], [4000.0, 4000.0, 400.0]] {
        let damped = SpringMaterial { air_damping: 0.02, ..material(stiffness) };
        let cloth = hanging(&Mass::PerVertex(EACH), damped, Tear::default());
        let exact = Settings { tolerance: 1e-6, ..settings(IntegratorKind::ImplicitEuler) };
        let mut simulation = in_wind(cloth, Vec::new(), exact);
        run(&mut simulation, 120);
        let loads = simulation.edge_tension(0);
        for row in 2..ROWS - 3 {
            let is_across = |[a, b]: [u32; 2]| a / COLUMNS == row && b / COLUMNS == row + 1;
            let across = loads.iter().filter(|(ends, _)| is_across(*ends));
            let force: f64 = across.map(|(_, tension)| tension).sum();
            let below = EACH * f64::from(COLUMNS * (row + 1)) * crate::sheets::G;
            assert!((force / below - 1.0).abs() < 0.01, "{stiffness:?}: {force} beside {below}");
        }
    }
}

/// What a limiter corrects has no force: where an edge is to break, none keeps it from that.
#[test]
fn no_limiter_keeps_an_edge_from_breaking() {
    let (force, weak, row) = (10.0, 0.15, 6);
    for limiter in [Limiter::None, Limiter::Stiffen, Limiter::Provot, Limiter::Project] {
        for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::SymplecticEuler] {
            // Soft: it would stretch by a fifth where it is to break.
            let soft = SpringMaterial {
                air_damping: 0.02,
                limiter,
                deformation_rate: 0.05,
                ..material([150.0, 0.0, 0.0])
            };
            let tear = Tear { force: Some(force), strength: weak_at(row, weak), ..Tear::default() };
            let cloth = hanging(&Mass::PerVertex(EACH), soft, tear);
            let mut simulation = in_wind(cloth, Vec::new(), settings(integrator));
            let g = load_until_torn(&mut simulation, 0.5);
            let expected = weak * force / (EACH * f64::from(row + 1));
            let found = (limiter, integrator);
            assert!((g / expected - 1.0).abs() < 0.03, "{found:?}: {g} beside {expected}");
        }
    }
}

/// The topmost edges bear all below them: `m g 12 = k 0.1 L0`.
#[test]
fn an_edge_breaks_at_its_strain_beyond_the_deformation_rate() {
    let stiffness = 150.0;
    for limiter in [Limiter::None, Limiter::Provot, Limiter::Project] {
        let soft = SpringMaterial {
            air_damping: 0.02,
            limiter,
            deformation_rate: 0.05,
            ..material([stiffness, 0.0, 0.0])
        };
        let tear = Tear { strain: Some(0.1), ..Tear::default() };
        let cloth = hanging(&Mass::PerVertex(EACH), soft, tear);
        let mut simulation = in_wind(cloth, Vec::new(), settings(IntegratorKind::ImplicitEuler));
        let g = load_until_torn(&mut simulation, 0.1);
        let expected = stiffness * 0.1 * SPACING / (EACH * f64::from(ROWS - 1));
        assert!((g / expected - 1.0).abs() < 0.03, "{limiter:?}: {g} beside {expected}");
    }
}

/// Before its time nothing tears.
#[test]
fn nothing_tears_before_its_first_frame() {
    let start = settings(IntegratorKind::ImplicitEuler).first_frame + 5;
    let tear = Tear { force: Some(0.0), start: Some(start), ..Tear::default() };
    let cloth = hanging(&Mass::PerVertex(EACH), material([400.0, 100.0, 5.0]), tear);
    let mut simulation = in_wind(cloth, Vec::new(), settings(IntegratorKind::ImplicitEuler));
    run(&mut simulation, 4);
    assert!(simulation.torn_edges(0).is_empty());
    run(&mut simulation, 1);
    assert!(!simulation.torn_edges(0).is_empty());
}

/// What has torn off falls as anything falls.
#[test]
fn the_lower_piece_falls_freely_and_nothing_is_lost() {
    let row = 6;
    let openings = vec![Opening {
        frame: 3,
        pairs: (0..COLUMNS - 1).map(|c| row * COLUMNS + c).map(|a| [a, a + 1]).collect(),
    }];
    let tear = Tear { openings, ..Tear::default() };
    let cloth = hanging(&Mass::PerVertex(EACH), material([400.0, 100.0, 5.0]), tear);
    let first = settings(IntegratorKind::ImplicitEuler).first_frame;
    let mut simulation = in_wind(cloth, Vec::new(), settings(IntegratorKind::ImplicitEuler));
    run(&mut simulation, usize::try_from(3 - first).expect("later"));
    assert_eq!(simulation.torn_edges(0).len(), COLUMNS as usize - 1);
    assert_eq!(simulation.positions(0).len(), (COLUMNS * ROWS + COLUMNS) as usize);
    let middle = |simulation: &Simulation| {
        let (positions, cloth) = (simulation.positions(0), simulation.cloth(0));
        let lower = |i: &usize| simulation.origins(0)[*i] / COLUMNS < row;
        let all: Vec<usize> = (0..positions.len()).filter(lower).collect();
        let mass: f64 = all.iter().map(|&i| cloth.masses[i]).sum();
        all.iter().map(|&i| cloth.masses[i] * positions[i].z).sum::<f64>() / mass
    };
    let before = middle(&simulation);
    run(&mut simulation, 24);
    let fallen = before - middle(&simulation);
    // It was swinging a little as it tore.
    assert!((4.0..5.5).contains(&fallen), "{fallen}");
    let mass: f64 = simulation.cloth(0).masses.iter().sum();
    assert!((mass - EACH * f64::from(COLUMNS * ROWS)).abs() < 1e-12);
    let faces = simulation.cloth(0).mesh.face_count();
    assert_eq!(faces, grid_mesh(COLUMNS, ROWS).face_count());
}

fn storm() -> Wind {
    let velocity = Vector::new(14.0, 9.0, 0.0);
    Wind { velocity, law: WindLaw::Face(Flow::new(1.2)), ..Wind::default() }
}

fn flag(threads: usize, integrator: IntegratorKind) -> Simulation {
    let tear = Tear { force: Some(0.6), noise: 0.3, seed: 3, ..Tear::default() };
    let n = 16;
    let pole: Vec<u32> = (0..n).map(|row| row * n).collect();
    let springs = SpringMaterial { deformation_rate: 0.5, ..material([300.0, 60.0, 2.0]) };
    let cloth = sheet([n, n], 0.06, &Mass::Density(0.15), springs, &pole);
    let positions = cloth.positions.iter().map(|x| Vector::new(x.x, 0.0, x.y)).collect();
    let collision = Some(Collision { thickness: 0.004, ..Collision::default() });
    let cloth = Cloth { positions, collision, tear: Some(tear), ..cloth };
    in_wind(cloth, vec![storm()], Settings { threads, ..settings(integrator) })
}

#[test]
fn a_flag_in_a_storm_tears_and_its_pieces_never_pass_through_each_other() {
    let mut simulation = flag(1, IntegratorKind::ImplicitEuler);
    for _ in 0..60 {
        let certificate = simulation.advance().expect("a frame");
        assert_eq!(certificate.intersections, Some(0), "frame {}", certificate.frame);
    }
    assert!(simulation.torn_edges(0).len() > 10, "{:?}", simulation.torn_edges(0));
    assert!(simulation.positions(0).iter().all(|x| x.norm() < 200.0));
}

fn bits(simulation: &Simulation) -> Vec<u64> {
    simulation.positions(0).iter().flatten().map(|x| x.to_bits()).collect()
}

#[test]
fn tears_are_the_same_on_any_number_of_threads_and_after_a_checkpoint() {
    for integrator in [IntegratorKind::ImplicitEuler, IntegratorKind::Bdf2, IntegratorKind::Verlet]
    {
        let mut one = flag(1, integrator);
        let mut two = flag(2, integrator);
        run(&mut one, 20);
        run(&mut two, 20);
        assert!(!one.torn_edges(0).is_empty(), "{integrator:?}");
        assert_eq!(bits(&one), bits(&two), "{integrator:?}");
        let mut again = flag(3, integrator);
        again.restore(&one.checkpoint()).expect("of the same flag");
        assert_eq!(again.torn_edges(0), one.torn_edges(0));
        assert_eq!(again.checkpoint(), one.checkpoint());
        run(&mut one, 10);
        run(&mut again, 10);
        assert_eq!(bits(&one), bits(&again), "{integrator:?}");
        // And back to where nothing was torn.
        let whole = flag(1, integrator).checkpoint();
        again.restore(&whole).expect("of the same flag");
        assert!(again.torn_edges(0).is_empty());
        assert_eq!(again.checkpoint(), whole);
        let mut fresh = flag(1, integrator);
        run(&mut fresh, 12);
        run(&mut again, 12);
        assert_eq!(bits(&fresh), bits(&again), "{integrator:?}");
    }
}

/// Two strips side by side, joined by seams alone.
#[test]
fn seams_come_undone_beyond_their_force_and_at_their_frame() {
    let of = |tear: Tear| {
        let top: Vec<u32> = (0..4).collect();
        let lower = sheet([4, 4], 0.1, &Mass::Density(0.2), material([200.0, 50.0, 1.0]), &top);
        let mut faces: Vec<Vec<u32>> = lower.mesh.faces().map(<[u32]>::to_vec).collect();
        faces.extend(lower.mesh.faces().map(|face| face.iter().map(|v| v + 16).collect()));
        let mesh = boucle_geometry::Mesh::from_faces(32, &faces).expect("two sheets");
        let upright = |x: &Vector, z: f64| Vector::new(x.x, 0.0, z - x.y);
        let above = lower.positions.iter().map(|x| upright(x, 0.0));
        let below = lower.positions.iter().map(|x| upright(x, -0.31));
        let positions = above.chain(below).collect();
        let springs = material([200.0, 50.0, 1.0]);
        let cloth = crate::sheets::cloth(mesh, positions, &Mass::Density(0.2), springs, &top);
        let seams = (0..4).map(|c| [12 + c, 16 + c]).collect();
        let cloth = cloth.sewn(Sewing { seams, ..Sewing::default() }).expect("sewn");
        in_wind(
            Cloth { tear: Some(tear), ..cloth },
            Vec::new(),
            settings(IntegratorKind::ImplicitEuler),
        )
    };
    let lowest = |simulation: &Simulation| {
        simulation.positions(0).iter().map(|x| x.z).fold(f64::INFINITY, f64::min)
    };
    // What hangs on four seams weighs 0.2 * 0.09 * 9.81 = 0.18 N; as it falls into them they bear more.
    for (force, holds) in [(2.0, true), (0.02, false)] {
        let mut simulation = of(Tear { seam_force: Some(force), ..Tear::default() });
        run(&mut simulation, 36);
        assert_eq!(lowest(&simulation) > -1.0, holds, "{force}: {}", lowest(&simulation));
    }
    let pairs = (0..4).map(|c| [12 + c, 16 + c]).collect();
    let mut simulation =
        of(Tear { openings: vec![Opening { frame: 20, pairs }], ..Tear::default() });
    let first = simulation.frame();
    run(&mut simulation, usize::try_from(20 - first).expect("later"));
    assert!(lowest(&simulation) > -1.0);
    run(&mut simulation, 24);
    assert!(lowest(&simulation) < -2.0);
}

/// Of a cloth that shrinks and is sewn, beside one that tears: nothing of it changes as the other does.
#[test]
fn another_cloth_does_not_notice_tears() {
    let openings = (3..12).map(|frame| {
        let first = (frame as u32 - 2) * COLUMNS;
        let pairs = (0..COLUMNS - 1).map(|c| [first + c, first + c + 1]).collect();
        Opening { frame, pairs }
    });
    let tear = Tear { openings: openings.collect(), ..Tear::default() };
    let torn = hanging(&Mass::PerVertex(EACH), material([400.0, 100.0, 5.0]), tear);
    let other = sheet([4, 4], 0.1, &Mass::Density(0.2), material([200.0, 50.0, 1.0]), &[0, 3]);
    let seams = vec![[5, 10]];
    let sewing = Sewing { seams, weld_distance: 1.0, ..Sewing::default() };
    let positions = other.positions.iter().map(|x| x + Vector::x() * 5.0).collect();
    let other = Cloth { positions, ..other }.sewn(sewing).expect("sewn");
    let whole = Cloth { tear: None, ..torn.clone() };
    let springs = |first: Cloth| {
        let settings = settings(IntegratorKind::ImplicitEuler);
        let cloths = vec![first, other.clone()];
        let mut simulation = Simulation::new(cloths, Vec::new(), settings).expect("a simulation");
        for frame in 0..14 {
            let shrink = vec![0.02 * f64::from(frame); 16];
            simulation.set_rest(1, None, Some(&shrink)).expect("accepted");
            simulation.advance().expect("a frame");
        }
        assert_eq!(simulation.welded_seams(), 1);
        let springs = &simulation.cloth(1).springs;
        springs.iter().map(|s| (s.rest_length, s.stiffness)).collect::<Vec<_>>()
    };
    assert_eq!(springs(torn), springs(whole));
}

#[test]
fn a_seam_that_bears_no_more_than_its_limit_does_not_come_undone_beyond_that() {
    let cloth = sheet([4, 4], 0.1, &Mass::Density(0.2), material([200.0, 50.0, 1.0]), &[0, 3]);
    let sewing = Sewing { seams: vec![[5, 15]], force_max: 0.01, ..Sewing::default() };
    let cloth = cloth.sewn(sewing).expect("sewn");
    let tear = Some(Tear { seam_force: Some(0.02), ..Tear::default() });
    let mut simulation =
        in_wind(Cloth { tear, ..cloth }, Vec::new(), settings(IntegratorKind::ImplicitEuler));
    run(&mut simulation, 10);
    assert_eq!(simulation.seam_gaps(0).len(), 1);
}

/// Without absorbency there is no wetness, and the numbers of the water are more than the vertices.
#[test]
fn a_scrap_in_water_tears() {
    let mesh = boucle_geometry::Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let positions = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]];
    let positions = positions.map(|[x, y]| Vector::new(x, y, 0.0)).to_vec();
    let springs = material([100.0, 20.0, 1.0]);
    let cloth = crate::sheets::cloth(mesh, positions, &Mass::Density(0.2), springs, &[]);
    let openings = vec![Opening { frame: 5, pairs: vec![[0, 2]] }];
    let tear = Some(Tear { openings, ..Tear::default() });
    let water = Some(boucle_solver::Water::default());
    let settings = Settings { water, ..settings(IntegratorKind::ImplicitEuler) };
    let mut simulation = in_wind(Cloth { tear, ..cloth }, Vec::new(), settings);
    run(&mut simulation, 10);
    assert_eq!(simulation.positions(0).len(), 6);
}

/// A hard pin stays whole also after it is let go; nothing is torn there in vain.
#[test]
fn what_was_a_hard_pin_stays_whole() {
    let mut simulation = flag(1, IntegratorKind::ImplicitEuler);
    let pole: Vec<u32> = (0..16).map(|row| row * 16).collect();
    simulation.release_pins(0, &pole);
    run(&mut simulation, 20);
    let origins = simulation.origins(0);
    assert!(origins[256..].iter().all(|origin| !pole.contains(origin)));
    let torn = simulation.torn_edges(0);
    let around_pole = torn.iter().filter(|edge| pole.contains(&edge[0]) && pole.contains(&edge[1]));
    assert_eq!(around_pole.count(), 0, "{torn:?}");
}

#[test]
fn torn_cloth_that_is_put_back_whole_still_has_two_sides() {
    let mut simulation = flag(1, IntegratorKind::ImplicitEuler);
    run(&mut simulation, 12);
    let origins = simulation.origins(0);
    assert!(origins.len() > 256);
    let given = simulation.given(0).positions.clone();
    simulation.set_positions(0, &given);
    assert_eq!(simulation.certificate().intersections, Some(0));
    let moved = simulation.positions(0);
    let way = moved.iter().zip(&origins).map(|(x, &origin)| (x - given[origin as usize]).norm());
    assert!(way.fold(0.0, f64::max) < 6e-5);
    let apart = origins.iter().enumerate().skip(256);
    assert!(
        apart.clone().all(|(piece, &origin)| (moved[piece] - moved[origin as usize]).norm() > 1e-6)
    );
    for _ in 0..6 {
        let certificate = simulation.advance().expect("a frame");
        assert_eq!(certificate.intersections, Some(0), "frame {}", certificate.frame);
    }
}

/// A sheet that lies on a table, and opens there.
#[test]
fn contacts_press_as_hard_at_the_frame_of_a_tear_as_before_it() {
    let n = 8;
    let pairs = (0..n - 1).map(|c| [3 * n + c, 3 * n + c + 1]).collect();
    let tear = Tear { openings: vec![Opening { frame: 40, pairs }], ..Tear::default() };
    let springs = SpringMaterial { air_damping: 0.01, ..material([200.0, 50.0, 1.0]) };
    let cloth = sheet([n, n], 0.05, &Mass::Density(0.2), springs, &[]);
    let positions = cloth.positions.iter().map(|x| x + Vector::z() * 0.003).collect();
    let collision = Some(Collision { thickness: 0.003, ..Collision::default() });
    let cloth = Cloth { positions, collision, tear: Some(tear), ..cloth };
    let weight = crate::sheets::G * cloth.masses.iter().sum::<f64>();
    let table = crate::contact_things::floor(0.3);
    let settings = settings(IntegratorKind::ImplicitEuler);
    let mut simulation = Simulation::with_colliders(vec![cloth], vec![table], Vec::new(), settings)
        .expect("a simulation");
    let pressed = |simulation: &Simulation| {
        simulation.vertex_contacts(0).iter().map(|force| f64::from(*force)).sum::<f64>()
    };
    let wait = usize::try_from(39 - simulation.frame()).expect("later");
    run(&mut simulation, wait);
    let before = pressed(&simulation);
    assert!((before / weight - 1.0).abs() < 0.1, "{before} beside {weight}");
    run(&mut simulation, 1);
    assert_eq!(simulation.torn_edges(0).len(), n as usize - 1);
    let now = pressed(&simulation);
    assert!((now / weight - 1.0).abs() < 0.1, "{now} beside {weight}");
    let forces = simulation.vertex_contacts(0);
    assert_eq!(forces.len(), simulation.positions(0).len());
    // Both sides of the middle row bear a part.
    assert!((64..forces.len()).all(|piece| forces[piece] > 0.0), "{:?}", &forces[64..]);
    run(&mut simulation, 1);
    assert!((pressed(&simulation) / weight - 1.0).abs() < 0.1, "{}", pressed(&simulation));
}
