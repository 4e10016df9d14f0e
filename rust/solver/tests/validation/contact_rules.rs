//! What collides with what: as it is said, and what makes no sense is refused in a sentence.

use boucle_geometry::Vector;
use boucle_solver::{
    Cloth, Collider, Collision, Error, IntegratorKind, Settings, Shape, Simulation, SpringMaterial,
};

use crate::contact_things::{among, ball, collider, colliding, floor, patch, placed};
use crate::sheets::run;

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 1, ..Settings::default() }
}

const RULES: [IntegratorKind; 2] = [IntegratorKind::Bdf2, IntegratorKind::SymplecticEuler];

const THICKNESS: f64 = 0.01;

/// Loose points as cloth is: springs so soft that every vertex goes its own way.
fn loose() -> SpringMaterial {
    crate::sheets::material([1e-6, 0.0, 0.0])
}

/// A patch of 8 x 8 at a height (m).
fn lifted(height: f64, material: SpringMaterial) -> Cloth {
    let cloth = placed(patch([8, 8], 0.3, material), |x| x + height * Vector::z());
    colliding(cloth, THICKNESS, 0.3)
}

fn with(cloth: Cloth, change: impl Fn(&mut Collision)) -> Cloth {
    let mut collision = cloth.collision.clone().expect("it collides");
    change(&mut collision);
    Cloth { collision: Some(collision), ..cloth }
}

fn lowest(simulation: &Simulation, cloth: usize) -> f64 {
    simulation.positions(cloth).iter().map(|x| x.z).fold(f64::INFINITY, f64::min)
}

/// Free fall is 0.31 m in six frames.
#[test]
fn a_cloth_that_does_not_collide_falls_through_everything() {
    for integrator in RULES {
        let ghost = Cloth { collision: None, ..lifted(0.1, SpringMaterial::default()) };
        let mut simulation = among(vec![ghost], vec![floor(0.3)], settings(integrator));
        assert_eq!(simulation.certificate().intersections, None);
        run(&mut simulation, 6);
        assert!(lowest(&simulation, 0) < -0.15, "{integrator:?}");
        assert_eq!(simulation.certificate().intersections, None, "nothing can touch");
    }
}

/// One that collides rests on the floor, the other passes through both.
#[test]
fn a_cloth_that_does_not_collide_passes_through_one_that_does() {
    for integrator in RULES {
        let ghost = Cloth { collision: None, ..lifted(0.1, SpringMaterial::default()) };
        let solid = lifted(0.05, SpringMaterial::default());
        let mut simulation = among(vec![ghost, solid], vec![floor(0.3)], settings(integrator));
        run(&mut simulation, 8);
        assert!(lowest(&simulation, 0) < -0.3, "{integrator:?}");
        assert!(lowest(&simulation, 1) > 0.0, "{integrator:?}");
        assert_eq!(simulation.certificate().intersections, Some(0), "{integrator:?}");
    }
}

#[test]
fn a_cloth_meets_the_colliders_of_its_list_and_no_others() {
    for integrator in RULES {
        let cloth = |list: Option<Vec<u32>>| {
            with(lifted(0.3, SpringMaterial::default()), |collision| {
                collision.colliders.clone_from(&list);
            })
        };
        let height = |list: Option<Vec<u32>>| {
            let shelf = vec![0.2 * Vector::z(), 1.2 * Vector::z()];
            let colliders = vec![collider(Shape::Plane, shelf, 0.3), floor(0.3)];
            let mut simulation = among(vec![cloth(list)], colliders, settings(integrator));
            run(&mut simulation, 12);
            assert_eq!(simulation.certificate().intersections, Some(0), "{integrator:?}");
            lowest(&simulation, 0)
        };
        assert!(height(None) > 0.2, "{integrator:?}");
        assert!(height(Some(vec![0])) > 0.2, "{integrator:?}");
        let below = height(Some(vec![1]));
        assert!(below > 0.0 && below < 0.19, "{integrator:?}: {below}");
        assert!(height(Some(Vec::new())) < -0.5, "{integrator:?}");
    }
}

/// Over a shelf lies a cloth, which carries another only if both say so.
#[test]
fn cloths_meet_if_both_name_each_other_or_name_none() {
    for integrator in RULES {
        let lowest_of_upper = |upper: Option<Vec<u32>>, lower: Option<Vec<u32>>| {
            let cloth = |height: f64, list: &Option<Vec<u32>>| {
                with(lifted(height, SpringMaterial::default()), |collision| {
                    collision.cloths.clone_from(list);
                })
            };
            let mut held = cloth(0.2, &lower);
            held.pins = (0..64).collect();
            let mut simulation =
                among(vec![cloth(0.3, &upper), held], vec![floor(0.3)], settings(integrator));
            run(&mut simulation, 12);
            assert_eq!(simulation.certificate().intersections, Some(0), "{integrator:?}");
            lowest(&simulation, 0)
        };
        for (upper, lower) in [
            (None, None),
            (Some(vec![1]), None),
            (None, Some(vec![0])),
            (Some(vec![1]), Some(vec![0])),
        ] {
            assert!(lowest_of_upper(upper, lower) > 0.2, "{integrator:?}");
        }
        for (upper, lower) in [
            (Some(vec![]), None),
            (None, Some(vec![])),
            (Some(vec![1]), Some(vec![1])),
            (Some(vec![]), Some(vec![0])),
        ] {
            let below = lowest_of_upper(upper, lower);
            assert!(below > 0.0 && below < 0.15, "{integrator:?}: {below}");
        }
    }
}

/// Strain, energies and hash are a cloth's own, and all else is everybody's.
#[test]
fn the_certificate_of_one_cloth_is_that_of_a_simulation_of_it_where_nothing_is_shared() {
    let ghost = |height: f64| Cloth { collision: None, ..lifted(height, loose()) };
    let pinned = Cloth { pins: vec![0, 7], ..ghost(0.5) };
    let settings = || Settings {
        step_size: boucle_solver::StepSize::Substeps(20),
        ..settings(IntegratorKind::SymplecticEuler)
    };
    let mut both = among(vec![ghost(0.1), pinned.clone()], Vec::new(), settings());
    run(&mut both, 5);
    for (number, cloth) in [ghost(0.1), pinned].into_iter().enumerate() {
        let mut alone = among(vec![cloth], Vec::new(), settings());
        run(&mut alone, 5);
        assert_eq!(both.certificate_of(number..number + 1), alone.certificate(), "{number}");
    }
    assert_eq!(both.certificate_of(0..2), both.certificate());
}

/// Three rows of vertices that no spring holds: the triangles between them fall through the floor, and with them the first
/// two rows, which have no others.
#[test]
fn only_triangles_whose_vertices_are_all_excluded_fall_through_the_floor() {
    for integrator in RULES {
        let cloth = with(lifted(0.05, loose()), |collision| {
            collision.excluded_from_colliders = (0..24).collect();
        });
        let mut simulation = among(vec![cloth], vec![floor(0.3)], settings(integrator));
        run(&mut simulation, 8);
        for (vertex, x) in simulation.positions(0).iter().enumerate() {
            let is_below = x.z < -0.1;
            assert_eq!(is_below, vertex < 16, "{integrator:?}: {vertex}");
            assert!(is_below || x.z > 0.0, "{integrator:?}: {vertex} at {}", x.z);
        }
        assert_eq!(simulation.certificate().intersections, Some(0), "{integrator:?}");
    }
}

/// Bit for bit as if nothing were excluded, on a ball and on each other.
#[test]
fn single_excluded_vertices_collide_as_all_others() {
    for integrator in RULES {
        let hash = |excluded: &[u32]| {
            let cloth = |height: f64| {
                with(lifted(height, crate::sheets::material([100.0, 20.0, 1.0])), |collision| {
                    collision.excluded_from_colliders = excluded.to_vec();
                    collision.excluded_from_self = excluded.to_vec();
                })
            };
            let cloths = vec![cloth(0.13), cloth(0.16)];
            let obstacle = ball(Vector::zeros(), 0.1, 0.3);
            let mut simulation = among(cloths, vec![obstacle], settings(integrator));
            run(&mut simulation, 8);
            let certificate = simulation.certificate();
            assert!(certificate.contacts > 0, "{integrator:?}");
            certificate.hash
        };
        assert_eq!(hash(&[0, 9, 27, 36, 63]), hash(&[]), "{integrator:?}");
    }
}

#[test]
fn positions_that_are_set_are_looked_at_for_intersections() {
    let sheet = |height: f64| lifted(height, SpringMaterial::default());
    let cloths = vec![sheet(0.1), sheet(0.2)];
    let mut simulation = among(cloths, vec![floor(0.3)], settings(IntegratorKind::Bdf2));
    let start = simulation.positions(1);
    let upright: Vec<Vector> = start.iter().map(|x| Vector::new(x.x, 0.013, 0.2 + x.y)).collect();
    let counts = [&upright, &start].map(|positions| {
        simulation.set_positions(1, positions);
        simulation.certificate().intersections.expect("they collide")
    });
    assert!(counts[0] > 0, "they cross");
    assert_eq!(counts[1], 0, "they do not any more");
}

/// Two halves of one cloth: loose points that are sent through each other.
fn halves(with_self: bool, excluded: &[u32], integrator: IntegratorKind) -> Simulation {
    let [lower, upper] = [0.0, 0.05].map(|height| lifted(height, loose()));
    let mut faces: Vec<[u32; 4]> = Vec::new();
    for base in [0, 64] {
        let quads = lower.mesh.faces().map(|corners| [0, 1, 2, 3].map(|i| base + corners[i]));
        faces.extend(quads);
    }
    let mesh = boucle_geometry::Mesh::from_faces(128, &faces).expect("two sheets");
    let positions = [lower.positions, upper.positions].concat();
    let cloth =
        crate::sheets::cloth(mesh, positions, &boucle_solver::Mass::Density(0.2), loose(), &[]);
    let cloth = with(colliding(cloth, THICKNESS, 0.3), |collision| {
        collision.with_self = with_self;
        collision.excluded_from_self = excluded.to_vec();
    });
    let settings = Settings { gravity: Vector::zeros(), ..settings(integrator) };
    let mut simulation = among(vec![cloth], Vec::new(), settings);
    let velocities: Vec<Vector> =
        (0..128).map(|vertex| if vertex < 64 { Vector::z() } else { -Vector::z() }).collect();
    simulation.set_velocities(0, &velocities);
    run(&mut simulation, 4);
    simulation
}

/// How far (m) the second half is above the first, at the least over the vertices.
fn least_gap(simulation: &Simulation) -> f64 {
    let positions = simulation.positions(0);
    (0..64).map(|i| positions[i + 64].z - positions[i].z).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_cloth_passes_through_itself_only_if_it_does_not_collide_with_itself() {
    for integrator in RULES {
        let solid = halves(true, &[], integrator);
        assert!(least_gap(&solid) > 0.0, "{integrator:?}: {}", least_gap(&solid));
        assert_eq!(solid.certificate().intersections, Some(0), "{integrator:?}");
        let ghost = halves(false, &[], integrator);
        // 2 m/s for a sixth of a second, from 0.05 m apart.
        assert!((least_gap(&ghost) + 0.2833).abs() < 1e-3, "{integrator:?}: {}", least_gap(&ghost));
        assert_eq!(ghost.certificate().contacts, 0, "{integrator:?}");
    }
}

#[test]
fn a_half_that_is_excluded_from_its_own_cloth_passes_through_the_other() {
    for integrator in RULES {
        let upper: Vec<u32> = (64..128).collect();
        let simulation = halves(true, &upper, integrator);
        assert!((least_gap(&simulation) + 0.2833).abs() < 1e-3, "{integrator:?}");
        assert_eq!(simulation.certificate().contacts, 0, "{integrator:?}");
    }
}

fn refusal(cloth: Cloth, colliders: Vec<Collider>) -> Error {
    Simulation::with_colliders(vec![cloth], colliders, Vec::new(), settings(IntegratorKind::Bdf2))
        .expect_err("a refusal")
}

#[test]
fn collisions_that_make_no_sense_are_refused_in_a_sentence() {
    let say = |change: &dyn Fn(&mut Collision)| {
        refusal(with(lifted(0.1, loose()), change), vec![floor(0.3)]).to_string()
    };
    let positive = "accepted: above 0, at most 100";
    for (thickness, given) in [(0.0, "0"), (-0.01, "-0.01"), (f64::NAN, "NaN"), (101.0, "101")] {
        let said = say(&|collision| collision.thickness = thickness);
        assert_eq!(said, format!("cloth \"patch\": thickness (m) is {given}; {positive}"));
    }
    for (friction, given) in [(-0.1, "-0.1"), (f64::NAN, "NaN"), (101.0, "101")] {
        let said = say(&|collision| collision.friction = friction);
        assert_eq!(said, format!("cloth \"patch\": friction is {given}; accepted: 0 to 100"));
    }
    let gone = "cloth \"patch\": excluded vertex 64 is not there; accepted: below 64";
    assert_eq!(say(&|collision| collision.excluded_from_self = vec![3, 64]), gone);
    assert_eq!(say(&|collision| collision.excluded_from_colliders = vec![64]), gone);
    assert_eq!(
        say(&|collision| collision.colliders = Some(vec![0, 1])),
        "cloth \"patch\": collider 1 is not there; accepted: below 1"
    );
}

#[test]
fn colliders_that_make_no_sense_are_refused_in_a_sentence() {
    let say = |collider: Collider| refusal(lifted(0.1, loose()), vec![collider]).to_string();
    let good = || ball(Vector::zeros(), 0.2, 0.3);
    let all = "collider \"collider\": ";
    for (collider, reason) in [
        (ball(Vector::zeros(), 0.0, 0.3), "radius (m) is 0; accepted: above 0, at most 100"),
        (ball(Vector::zeros(), f64::NAN, 0.3), "radius (m) is NaN; accepted: above 0, at most 100"),
        (Collider { friction: -1.0, ..good() }, "friction is -1; accepted: 0 to 100"),
        (
            Collider { positions: vec![Vector::zeros(); 2], ..good() },
            "2 points are given; accepted: 1",
        ),
        (
            ball(Vector::new(0.0, f64::INFINITY, 0.0), 0.2, 0.3),
            "point 0 is at (0, inf, 0) m; accepted: finite, within 1e6 m of the origin",
        ),
        (
            collider(Shape::Plane, vec![Vector::x(); 2], 0.3),
            "its normal has no length; accepted: any other",
        ),
        (collider(Shape::cuboid(), vec![Vector::x(); 7], 0.3), "7 points are given; accepted: 8"),
    ] {
        assert_eq!(say(collider), format!("{all}{reason}"));
    }
    // A collider's own thickness may be nothing: the sentence must not ask for more than that.
    let said = say(Collider { thickness: -0.1, ..good() });
    assert_eq!(said, format!("{all}thickness (m) is -0.1; accepted: 0 to 100"));
}

#[test]
fn a_collider_sent_to_no_place_is_refused_and_stays() {
    let mut simulation = among(
        vec![lifted(0.1, loose())],
        vec![ball(Vector::zeros(), 0.05, 0.3)],
        settings(IntegratorKind::Bdf2),
    );
    let before = simulation.checkpoint();
    for targets in [vec![], vec![Vector::zeros(); 2], vec![Vector::new(f64::NAN, 0.0, 0.0)]] {
        let error = simulation.set_collider_targets(0, &targets).expect_err("a refusal");
        assert!(matches!(error, Error::BadCollider { .. }), "{error:?}");
    }
    assert!(simulation.checkpoint() == before);
    run(&mut simulation, 2);
}
