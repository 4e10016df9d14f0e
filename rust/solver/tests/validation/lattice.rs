//! The square lattice of springs as an elastic sheet: its moduli, by energy and by pulling.

use boucle_geometry::Vector;
use boucle_solver::{Cloth, IntegratorKind, Mass, Settings, SpringKind, StepSize};

use crate::reference::{LATTICES, Table};
use crate::sheets::{
    assert_close, classic, grid_positions, material, network, run, sheet, simulation, spring,
    steps_of,
};

/// Energy (J) of a lattice, 1 m apart, under the strains e11, e22 and e12.
fn energy(counts: [u32; 2], stiffness: [f64; 3], [e11, e22, e12]: [f64; 3]) -> f64 {
    let cloth = sheet(counts, 1.0, &Mass::PerVertex(1.0), material(stiffness), &[]);
    let strained =
        |x: &Vector| Vector::new(x.x + e11 * x.x + e12 * x.y, x.y + e12 * x.x + e22 * x.y, 0.0);
    let positions: Vec<Vector> = cloth.positions.iter().map(strained).collect();
    let mut simulation = simulation(cloth, steps_of(1.0, IntegratorKind::SymplecticEuler));
    simulation.set_positions(0, &positions);
    simulation.certificate().potential_energy
}

/// Energy (J/m²) of a cell far from all edges: what a row and a column more add, less what each adds alone.
fn energy_density(stiffness: [f64; 3], strain: [f64; 3]) -> f64 {
    let of = |columns, rows| energy([columns, rows], stiffness, strain);
    of(8, 8) - of(7, 8) - of(8, 7) + of(7, 7)
}

/// Central differences over a strain of 1e-4, whose square is the error of moduli for small strain; 1e-6 leaves room.
#[test]
fn a_cell_of_the_lattice_has_the_moduli_of_the_table() {
    let e = 1e-4;
    for row in Table::of(LATTICES).rows() {
        let stiffness = ["ks", "kd", "kb"].map(|name| row.number(name));
        let second = |a: [f64; 3], b: [f64; 3]| {
            let at = |s: f64, t: f64| {
                let strain = std::array::from_fn(|i| e * (s * a[i] + t * b[i]));
                energy_density(stiffness, strain)
            };
            (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * e * e)
        };
        let (along, across, sheared) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]);
        let [c11, c12, c66] =
            [(along, along), (along, across), (sheared, sheared)].map(|(a, b)| second(a, b));
        let what = row.text("springs");
        for (modulus, name) in [(c11, "C11"), (c12, "C12"), (c66, "C66")] {
            let expected = row.number(name);
            assert!((modulus - expected).abs() < 1e-6 * c11, "{what}: {name} is {modulus}");
        }
        assert_close(what, c11 - c12 * c12 / c11, row.number("Y_uniaxial"), 1e-6);
        assert!((c12 / c11 - row.number("nu_uniaxial")).abs() < 1e-6, "{what}");
    }
}

const COUNT: u32 = 10;

/// Length (m) of the springs that pull at the ends, and how far they are drawn out.
const ROPE: f64 = 1000.0;

/// A square lattice whose outermost edges are half as stiff, for they border one cell and not two, pulled at both
/// ends along x by long soft springs, half as strong at the corners.
fn pulled_lattice(ks: f64, kd: f64) -> Cloth {
    let mut positions = grid_positions(COUNT, COUNT, 1.0);
    let cells = sheet([COUNT, COUNT], 1.0, &Mass::PerVertex(1.0), material([ks, kd, 0.0]), &[]);
    let mut springs = cells.springs;
    springs.retain(|spring| spring.kind != SpringKind::Bend);
    let last = f64::from(COUNT - 1);
    let is_border = |x: f64| x < 0.1 || x > last - 0.1;
    for spring in springs.iter_mut().filter(|spring| spring.kind == SpringKind::Stretch) {
        let middle = spring.ends.map(|end| positions[end as usize]).iter().sum::<Vector>() * 0.5;
        if is_border(middle.x) || is_border(middle.y) {
            spring.stiffness *= 0.5;
        }
    }
    let mut pins = Vec::new();
    for row in 0..COUNT {
        let strength = if row == 0 || row == COUNT - 1 { 0.5 } else { 1.0 };
        for (column, side) in [(0, -1.0), (COUNT - 1, 1.0)] {
            let vertex = row * COUNT + column;
            let anchor = positions[vertex as usize] + Vector::x() * (side * (ROPE + 1.0));
            let pin = positions.len() as u32;
            springs.push(spring([vertex, pin], ROPE, 1e-5 * strength));
            positions.push(anchor);
            pins.push(pin);
        }
    }
    let masses = vec![1.0; positions.len()];
    // About critical damping of the slowest of the lattice's own motions, pi/20 of a radian a second.
    let material = boucle_solver::SpringMaterial { air_damping: 0.25, ..material([ks, kd, 0.0]) };
    network(positions, springs, masses, &pins, material)
}

/// Strains of 1e-5 are linear to 1e-5 of themselves, and what is left after 400 s of damping is less.
#[test]
fn a_pulled_lattice_is_as_stiff_and_as_narrow_as_the_table_says() {
    for row in Table::of(LATTICES).rows().filter(|row| row.text("kb") == "0") {
        let [ks, kd] = ["ks", "kd"].map(|name| row.number(name));
        let settings = Settings {
            gravity: Vector::zeros(),
            fps: 0.1,
            step_size: StepSize::Auto,
            threads: 1,
            ..classic()
        };
        let mut simulation = simulation(pulled_lattice(ks, kd), settings);
        run(&mut simulation, 40);
        let positions = simulation.positions(0);
        let at = |column: u32, row: u32| positions[(row * COUNT + column) as usize];
        let span = f64::from(COUNT - 1);
        let strain = |a: f64, b: f64| (b - a) / span - 1.0;
        let along = strain(at(0, 4).x, at(COUNT - 1, 4).x);
        let across = strain(at(4, 0).y, at(4, COUNT - 1).y);
        // Tension (N/m) from the ropes as they hang now: nine full ropes on nine metres, halves at the corners.
        let rope = positions[(COUNT * COUNT + 9) as usize] - at(COUNT - 1, 4);
        let tension = 1e-5 * (rope.norm() - ROPE);
        let what = row.text("springs");
        assert_close(what, tension / along, row.number("Y_uniaxial"), 5e-5);
        assert!((-across / along - row.number("nu_uniaxial")).abs() < 5e-5, "{what}");
    }
}
