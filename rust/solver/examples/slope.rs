#![allow(missing_docs, clippy::all, clippy::pedantic, clippy::unwrap_used)]
use boucle_geometry::{Mesh, Vector};
use boucle_solver::*;
fn env<T: std::str::FromStr>(k: &str, d: T) -> T {
    std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(d)
}
fn main() {
    let n = 8u32;
    let mut p = vec![];
    let mut f: Vec<Vec<u32>> = vec![];
    for j in 0..n {
        for i in 0..n {
            p.push(Vector::new(
                0.25 * (i as f64 / (n - 1) as f64 - 0.5),
                0.25 * (j as f64 / (n - 1) as f64 - 0.5),
                0.0075,
            ));
        }
    }
    for j in 0..n - 1 {
        for i in 0..n - 1 {
            let a = j * n + i;
            f.push(vec![a, a + 1, a + n + 1, a + n]);
        }
    }
    let mesh = Mesh::from_faces(p.len(), &f).unwrap();
    let mu = env("MU", 0.2f64);
    let mut c =
        Cloth::from_mesh("patch", mesh, p, &Mass::Density(0.2), SpringMaterial::default(), vec![])
            .unwrap();
    c.collision = Some(Collision { thickness: 0.008, friction: mu, ..Default::default() });
    let plane = Collider {
        name: "f".into(),
        shape: Shape::Plane,
        positions: vec![Vector::zeros(), Vector::z()],
        thickness: 0.0,
        friction: mu,
    };
    let a = (mu.atan().to_degrees() + env("OVER", 1.0)).to_radians();
    let g = Vector::new(9.81 * a.sin(), 0.0, -9.81 * a.cos());
    let mass: f64 = c.masses.iter().sum();
    let s = Settings {
        gravity: g,
        integrator: if env("IE", 0) == 1 {
            IntegratorKind::ImplicitEuler
        } else {
            IntegratorKind::Bdf2
        },
        ..Default::default()
    };
    let mut sim = Simulation::with_colliders(vec![c], vec![plane], vec![], s).unwrap();
    for _ in 0..env("FRAMES", 24) {
        let c = sim.advance().unwrap();
        let sum: f32 = sim.vertex_contacts(0).iter().sum();
        let v = sim.velocities(0);
        let m: Vector = v.iter().sum::<Vector>() / 64.0;
        let x: Vector = sim.positions(0).iter().sum::<Vector>() / 64.0;
        println!(
            "{} sub {} it {} pressure {:.4} of {:.4} x {:.6} z {:.6} v {:.5} {:.5} clipped {} contacts {}",
            c.frame,
            c.substeps,
            c.iterations,
            sum,
            mass * 9.81 * a.cos(),
            x.x,
            x.z,
            m.x,
            m.z,
            c.clipped,
            c.contacts
        );
    }
}
