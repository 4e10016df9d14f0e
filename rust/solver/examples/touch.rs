#![allow(missing_docs, clippy::all, clippy::pedantic, clippy::unwrap_used)]
use boucle_geometry::{Mesh, Vector};
use boucle_solver::*;
fn env<T: std::str::FromStr>(k: &str, d: T) -> T {
    std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(d)
}
fn grid(n: u32, size: f64, z: f64) -> (Mesh, Vec<Vector>) {
    let mut p = vec![];
    let mut f: Vec<Vec<u32>> = vec![];
    for j in 0..n {
        for i in 0..n {
            p.push(Vector::new(
                size * (i as f64 / (n - 1) as f64 - 0.5),
                size * (j as f64 / (n - 1) as f64 - 0.5),
                z,
            ));
        }
    }
    for j in 0..n - 1 {
        for i in 0..n - 1 {
            let a = j * n + i;
            f.push(vec![a, a + 1, a + n + 1, a + n]);
        }
    }
    (Mesh::from_faces(p.len(), &f).unwrap(), p)
}
fn main() {
    let n = env("SIDE", 32u32);
    let frames = env("FRAMES", 36);
    let material = SpringMaterial {
        stiffness: [env("KS", 500.0), env("KD", 100.0), env("KB", 5.0)],
        deformation_rate: env("RATE", 0.1),
        ..Default::default()
    };
    let scene = std::env::var("SCENE").unwrap_or("sphere".into());
    let (mesh, pos) = grid(n, 2.0, 0.0);
    let pins = vec![];
    let mut cloth = Cloth::from_mesh(
        "sheet",
        mesh.clone(),
        pos.clone(),
        &Mass::Density(0.2),
        material.clone(),
        pins,
    )
    .unwrap();
    cloth.collision = Some(Collision {
        with_self: env("SELF", 1) == 1,
        thickness: env("THICK", 0.002),
        friction: env("MU", 0.3),
        ..Default::default()
    });
    let mut cloths = vec![cloth];
    let mut colliders = vec![];
    let col = |name: &str, shape, positions| Collider {
        name: name.into(),
        shape,
        positions,
        thickness: 0.0,
        friction: env("MU", 0.3),
    };
    match scene.as_str() {
        "sphere" => colliders.push(col(
            "ball",
            Shape::Sphere { radius: 0.5 },
            vec![Vector::new(0.0, 0.0, -0.6)],
        )),
        "plane" => colliders.push(col(
            "floor",
            Shape::Plane,
            vec![Vector::new(0.0, 0.0, -0.3), Vector::new(0.0, 0.0, 0.7)],
        )),
        "box" => colliders.push(col(
            "box",
            Shape::cuboid(),
            (0..8)
                .map(|i| {
                    let s = 0.4;
                    let v = Vector::new(
                        if i & 1 > 0 { s } else { -s },
                        if i & 2 > 0 { s } else { -s },
                        if i & 4 > 0 { s } else { -s },
                    );
                    v + Vector::new(0., 0., -0.5)
                })
                .collect(),
        )),
        "two" => {
            let (m, p) = grid(n, 1.6, 0.05);
            let mut c =
                Cloth::from_mesh("upper", m, p, &Mass::Density(0.2), material.clone(), vec![])
                    .unwrap();
            c.collision = cloths[0].collision.clone();
            cloths.push(c);
            colliders.push(col(
                "ball",
                Shape::Sphere { radius: 0.5 },
                vec![Vector::new(0.0, 0.0, -0.6)],
            ));
        }
        "cross" => {
            // two sheets crossing in an X
            let tilt = |p: &mut Vec<Vector>, a: f64| {
                for v in p.iter_mut() {
                    let (x, z) = (v.x, v.z);
                    v.x = x * a.cos();
                    v.z = x * a.sin() + z;
                }
            };
            let (m, mut p) = grid(n, 1.0, 0.003);
            tilt(&mut p, 0.3);
            let c =
                Cloth::from_mesh("b", m, p, &Mass::Density(0.2), material.clone(), vec![]).unwrap();
            let (m, mut p) = grid(n, 1.0, 0.0);
            tilt(&mut p, -0.3);
            let d =
                Cloth::from_mesh("a", m, p, &Mass::Density(0.2), material.clone(), vec![]).unwrap();
            let col = cloths[0].collision.clone();
            cloths = vec![Cloth { collision: col.clone(), ..d }, Cloth { collision: col, ..c }];
            colliders.push(Collider {
                name: "f".into(),
                shape: Shape::Plane,
                positions: vec![Vector::new(0., 0., -0.5), Vector::new(0., 0., 0.5)],
                thickness: 0.0,
                friction: 0.3,
            });
        }
        "halfsphere" => colliders.push(col(
            "ball",
            Shape::Sphere { radius: 0.4 },
            vec![Vector::new(1.0, 0.0, -0.05)],
        )),
        "midsphere" => colliders.push(col(
            "ball",
            Shape::Sphere { radius: 0.4 },
            vec![Vector::new(0.0, 0.0, -0.05)],
        )),
        "halfbox" => colliders.push(col(
            "box",
            Shape::cuboid(),
            (0..8)
                .map(|i| {
                    let s = 0.3;
                    let v = Vector::new(
                        if i & 1 > 0 { s } else { -s },
                        if i & 2 > 0 { s } else { -s },
                        if i & 4 > 0 { s } else { -s },
                    );
                    v + Vector::new(1.0, 0., -0.2)
                })
                .collect(),
        )),
        "midbox" => colliders.push(col(
            "box",
            Shape::cuboid(),
            (0..8)
                .map(|i| {
                    let s = 0.3;
                    let v = Vector::new(
                        if i & 1 > 0 { s } else { -s },
                        if i & 2 > 0 { s } else { -s },
                        if i & 4 > 0 { s } else { -s },
                    );
                    v + Vector::new(0.0, 0., -0.2)
                })
                .collect(),
        )),
        "foldself" => {
            // a sheet bent so that its end passes through itself
            let mut p = pos.clone();
            for v in p.iter_mut() {
                let s = (v.x + 1.0) / 2.0;
                let a = s * 6.9;
                let r = 0.3;
                v.x = r * a.cos();
                v.z = r * a.sin() + 0.001 * v.y + 0.02 * (s - 0.5);
            }
            let c = Cloth::from_mesh(
                "roll",
                mesh.clone(),
                p,
                &Mass::Density(0.2),
                material.clone(),
                vec![],
            )
            .unwrap();
            let col = cloths[0].collision.clone();
            cloths = vec![Cloth { collision: col, ..c }];
            colliders.push(Collider {
                name: "f".into(),
                shape: Shape::Plane,
                positions: vec![Vector::new(0., 0., -0.5), Vector::new(0., 0., 0.5)],
                thickness: 0.0,
                friction: 0.3,
            });
        }
        _ => {}
    }
    let settings = Settings {
        integrator: if env("IE", 0) == 1 {
            IntegratorKind::ImplicitEuler
        } else if env("SE", 0) == 1 {
            IntegratorKind::SymplecticEuler
        } else {
            IntegratorKind::Bdf2
        },
        perturbation: 1e-6,
        threads: env("THREADS", 2),
        step_size: match env("SUB", 0u32) {
            0 => StepSize::Auto,
            k => StepSize::Substeps(k),
        },
        ..Default::default()
    };
    let mut sim = Simulation::with_colliders(cloths, colliders, vec![], settings).unwrap();
    let mut total = 0.0;
    for f in 0..frames {
        let t = std::time::Instant::now();
        let c = sim.advance();
        let s = t.elapsed().as_secs_f64();
        total += s;
        match c {
            Ok(c) => println!(
                "{:3} {:8.1} ms sub {:3} it {:5} strain {:6.2}% contacts {:6} clipped {:6} X {:?} E {:.3} h {:016x}",
                c.frame,
                s * 1e3,
                c.substeps,
                c.iterations,
                c.max_strain * 100.0,
                c.contacts,
                c.clipped,
                c.intersections.unwrap_or(0),
                c.kinetic_energy,
                c.hash
            ),
            Err(e) => {
                println!("frame {f}: {e}");
                break;
            }
        }
    }
    println!("mean {:.1} ms", total / frames as f64 * 1e3);
    if let Ok(path) = std::env::var("OBJ") {
        let mut s = String::new();
        let mut base = 1;
        for c in 0..sim.cloth_count() {
            for p in sim.positions(c) {
                s += &format!("v {} {} {}\n", p.x, p.y, p.z);
            }
            for f in sim.cloth(c).mesh.faces() {
                s += "f";
                for v in f {
                    s += &format!(" {}", v + base);
                }
                s += "\n";
            }
            base += sim.positions(c).len() as u32;
        }
        std::fs::write(path, s).unwrap();
    }
}
