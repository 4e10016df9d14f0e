//! Energy and momentum among contacts: nothing is gained, what rests comes to rest, and cloths that meet share what they have.

use boucle_geometry::Vector;
use boucle_solver::{
    Certificate, Cloth, IntegratorKind, Settings, Simulation, SpringMaterial, StepSize,
};

use crate::contact_things::{among, ball, colliding, floor, patch, placed};
use crate::sheets::run;

fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, threads: 1, perturbation: 1e-6, ..Settings::default() }
}

fn dropped(height: f64, integrator: IntegratorKind) -> Simulation {
    let tilted = |x: &Vector| Vector::new(x.x, x.y, height + 0.2 * x.x + 0.1 * x.y);
    let cloth = placed(patch([12, 12], 0.4, SpringMaterial::default()), tilted);
    among(vec![colliding(cloth, 0.008, 0.3)], vec![floor(0.3)], settings(integrator))
}

fn energy(certificate: &Certificate) -> f64 {
    certificate.kinetic_energy + certificate.potential_energy
}

/// The energy of contacts is not counted: they may give back the part of the fall that they store at its end. A contact is 20
/// times as stiff as inertia is over a step: that is below a twentieth.
#[test]
fn a_sheet_dropped_on_a_floor_never_gains_energy() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler, IntegratorKind::Verlet]
    {
        let mut simulation = dropped(0.3, integrator);
        let mut least = energy(&simulation.certificate());
        let whole = least;
        for _ in 0..36 {
            let certificate = simulation.advance().expect("a frame");
            let now = energy(&certificate);
            let gain = (now - least) / whole;
            assert!(gain < 0.03, "{integrator:?}, frame {}: gained {gain}", certificate.frame);
            least = least.min(now);
        }
        assert!(least < 0.2 * whole, "{integrator:?}: it has not fallen");
    }
}

fn mass(cloth: &Cloth) -> f64 {
    cloth.masses.iter().sum()
}

#[test]
fn a_sheet_dropped_on_a_floor_comes_to_rest_within_two_seconds() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler] {
        let mut simulation = dropped(0.1, integrator);
        run(&mut simulation, 48);
        let per_mass = simulation.certificate().kinetic_energy / mass(simulation.cloth(0));
        assert!(per_mass < 1e-6, "{integrator:?}: {per_mass} J/kg");
    }
}

#[test]
fn a_sheet_laid_on_a_floor_stays_at_rest() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler] {
        let cloth =
            placed(patch([12, 12], 0.4, SpringMaterial::default()), |x| x + 0.008 * Vector::z());
        let cloths = vec![colliding(cloth, 0.008, 0.3)];
        let mut simulation = among(cloths, vec![floor(0.3)], settings(integrator));
        run(&mut simulation, 12);
        for _ in 0..36 {
            let certificate = simulation.advance().expect("a frame");
            let per_mass = certificate.kinetic_energy / mass(simulation.cloth(0));
            assert!(
                per_mass < 1e-6,
                "{integrator:?}, frame {}: {per_mass} J/kg",
                certificate.frame
            );
        }
        // Where the ramped force of a contact carries the weight, within steps of a 48th of a second or less.
        let deepest = f64::sqrt(2.0 * 0.25 * 0.008 * 9.81 / (20.0 * 48.0 * 48.0));
        for x in simulation.positions(0) {
            let depth = 0.008 - x.z;
            assert!(depth > 0.0 && depth < 1.05 * deepest, "{integrator:?}: {depth} of {deepest}");
        }
    }
}

/// A sheet over a ball much smaller than itself sways longer: three seconds.
#[test]
fn a_sheet_on_a_ball_comes_to_rest() {
    let cloth = placed(
        patch([16, 16], 0.5, SpringMaterial { damping: [0.02; 3], ..SpringMaterial::default() }),
        |x| x + 0.22 * Vector::z(),
    );
    let cloths = vec![colliding(cloth, 0.008, 0.5)];
    let mut simulation =
        among(cloths, vec![ball(Vector::zeros(), 0.2, 0.5)], settings(IntegratorKind::Bdf2));
    run(&mut simulation, 96);
    let per_mass = simulation.certificate().kinetic_energy / mass(simulation.cloth(0));
    assert!(per_mass < 1e-4, "{per_mass} J/kg");
}

/// Momentum (kg m/s) and angular momentum about the origin (kg m²/s) of all cloths.
fn momenta(simulation: &Simulation) -> [Vector; 2] {
    let mut sums = [Vector::zeros(); 2];
    for cloth in 0..simulation.cloth_count() {
        let (positions, velocities) = (simulation.positions(cloth), simulation.velocities(cloth));
        let masses = &simulation.cloth(cloth).masses;
        for ((x, v), mass) in positions.iter().zip(&velocities).zip(masses) {
            sums[0] += *mass * v;
            sums[1] += *mass * x.cross(v);
        }
    }
    sums
}

/// Two free sheets without gravity that meet askew at 2 m/s, the second twice as wide and twice as fast to the side.
fn meeting(integrator: IntegratorKind, step_size: StepSize, friction: f64) -> Simulation {
    let material = SpringMaterial::default();
    let turned = |x: &Vector| Vector::new(x.x, 0.96 * x.y, 0.28 * x.y + 0.08);
    let cloths = vec![
        colliding(patch([14, 14], 0.5, material.clone()), 0.008, friction),
        colliding(placed(patch([9, 9], 0.3, material), turned), 0.008, friction),
    ];
    let settings = Settings { gravity: Vector::zeros(), step_size, ..settings(integrator) };
    let mut simulation = among(cloths, Vec::new(), settings);
    simulation.set_velocities(0, &[Vector::new(0.1, 0.0, 1.0); 196]);
    simulation.set_velocities(1, &[Vector::new(0.3, -0.1, -1.0); 81]);
    simulation
}

#[test]
fn cloths_that_meet_without_gravity_keep_their_momentum() {
    for integrator in [IntegratorKind::Bdf2, IntegratorKind::ImplicitEuler, IntegratorKind::Verlet]
    {
        let mut simulation = meeting(integrator, StepSize::Auto, 0.3);
        let [before, _] = momenta(&simulation);
        let speed = 2.0 * mass(simulation.cloth(1));
        let mut most = 0.0_f64;
        for _ in 0..12 {
            let certificate = simulation.advance().expect("a frame");
            most = most.max(f64::from(certificate.contacts));
            let lost = (momenta(&simulation)[0] - before).norm() / speed;
            let frame = certificate.frame;
            assert!(
                lost < 1e-6,
                "{integrator:?}, frame {frame}: {lost:e} of the momentum, {} clipped",
                certificate.clipped
            );
        }
        assert!(most > 0.0, "{integrator:?}: they do not meet");
        let bounced = simulation.velocities(1).iter().map(|v| v.z).sum::<f64>() / 81.0;
        assert!(bounced > -0.5, "{integrator:?}: nothing was exchanged, {bounced} m/s");
    }
}
