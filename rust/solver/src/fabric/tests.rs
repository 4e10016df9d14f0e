//! Laws against differences, and bending against closed forms.

use super::*;
use crate::Mass;
use crate::kernel::ChunkVectors;
use crate::material::SpringMaterial;
use crate::scatter::scattered;
use boucle_geometry::Mesh;

/// A cloth whose faces are triangles.
pub(super) fn cloth(
    faces: &[[u32; 3]],
    positions: Vec<Vector>,
    density: f64,
    fabric: Fabric,
) -> Cloth {
    let mesh = Mesh::from_faces(positions.len(), faces).expect("triangles");
    let mass = Mass::Density(density);
    let material = SpringMaterial { limiter: crate::Limiter::None, ..SpringMaterial::default() };
    let made = Cloth::from_mesh("sheet", mesh, positions, &mass, material, Vec::new());
    made.and_then(|cloth| cloth.of_fabric(fabric)).expect("a cloth")
}

/// A grid of triangles over `size` (m), inner vertices moved by `jitter` cells.
pub(super) fn sheet(cells: [u32; 2], size: [f64; 2], jitter: f64) -> (Vec<[u32; 3]>, Vec<Vector>) {
    let columns = cells[0] + 1;
    let mut faces = Vec::new();
    for (c, r) in (0..cells[1]).flat_map(|r| (0..cells[0]).map(move |c| (c, r))) {
        let a = r * columns + c;
        let [b, d, e] = [a + 1, a + columns + 1, a + columns];
        if (c + r) % 2 == 0 {
            faces.extend([[a, b, d], [a, d, e]]);
        } else {
            faces.extend([[a, b, e], [b, d, e]]);
        }
    }
    let positions = (0..columns * (cells[1] + 1)).map(|i| {
        let (c, r) = (i % columns, i / columns);
        let is_inner = c > 0 && r > 0 && c < cells[0] && r < cells[1];
        let shift = |k: u64| if is_inner { jitter * scattered(2 * u64::from(i) + k) } else { 0.0 };
        let x = (f64::from(c) + shift(0)) * size[0] / f64::from(cells[0]);
        let y = (f64::from(r) + shift(1)) * size[1] / f64::from(cells[1]);
        Vector::new(x, y, 0.0)
    });
    (faces, positions.collect())
}

pub(super) fn uneven() -> Fabric {
    Fabric {
        stretch: [2000.0, 1200.0],
        compression: [300.0, 500.0],
        shear: 80.0,
        bend: [3e-3, 1e-3],
        damping_ratio: [0.0; 3],
        warp: Warp::Along(Vector::new(0.3, 1.0, 0.0)),
        ..Fabric::default()
    }
}

/// A crumpled sheet of fabric in a state.
fn crumpled() -> (Cloth, State) {
    let (faces, positions) = sheet([4, 3], [0.4, 0.3], 0.2);
    let cloth = cloth(&faces, positions, 0.2, uneven());
    let moved: Vec<Vector> = cloth
        .positions
        .iter()
        .enumerate()
        .map(|(i, x)| x + 0.02 * Vector::from_fn(|axis, _| scattered(3 * i as u64 + axis as u64)))
        .collect();
    let state = State::at_rest(&moved);
    (cloth, state)
}

pub(super) fn forces(fabrics: &Fabrics, state: &State) -> Vec<Vector> {
    let mut scratch = FabricScratch::default();
    fabrics.observe(state, &mut scratch);
    let mut sums: Box<ChunkVectors> = Box::new([[0.0; _]; 3]);
    fabrics.add_forces(pulp::Scalar::new(), 0, state, &scratch, &mut sums);
    (0..state.len()).map(|i| Vector::from_fn(|axis, _| sums[axis][i])).collect()
}

/// Forces against central differences of the energy, of every particle and axis.
pub(super) fn assert_forces_are_the_slope(fabrics: &Fabrics, state: &State) {
    let forces = forces(fabrics, state);
    let largest = forces.iter().map(Vector::norm).fold(0.0, f64::max);
    for (particle, force) in forces.iter().enumerate() {
        for axis in 0..3 {
            let at = |step: f64| {
                let mut moved = state.clone();
                moved.position.0[axis][particle] += step;
                fabrics.energy(0..1, &moved)
            };
            let slope = -(at(1e-6) - at(-1e-6)) / 2e-6;
            let error = (force[axis] - slope).abs() / largest;
            assert!(error < 1e-6, "particle {particle}, axis {axis}: {error:e}");
        }
    }
}

#[test]
fn forces_are_the_slope_of_the_energy() {
    let (cloth, state) = crumpled();
    assert_forces_are_the_slope(&Fabrics::new(&[cloth]), &state);
}

/// The bent shape of a sheet: a cylinder about a direction, flat to first order.
fn bent(positions: &[Vector], curvature: f64, degrees: f64) -> State {
    let (s, c) = degrees.to_radians().sin_cos();
    let height = |x: &Vector| 0.5 * curvature * (c * x.x + s * x.y).powi(2);
    let bent: Vec<Vector> = positions.iter().map(|x| Vector::new(x.x, x.y, height(x))).collect();
    State::at_rest(&bent)
}

/// What a square metre bent to a cylinder stores, beside `B/2` times its squared curvature.
fn stored(cells: u32, jitter: f64, degrees: f64) -> f64 {
    let (faces, positions) = sheet([cells; 2], [1.0; 2], jitter);
    let (bend, curvature) = (2e-3, 0.1);
    let none = [0.0; 2];
    let fabric = Fabric {
        stretch: none,
        compression: none,
        shear: 0.0,
        bend: [bend; 2],
        ..Fabric::default()
    };
    let fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, fabric)]);
    let state = bent(&positions, curvature, degrees);
    fabrics.energy(0..1, &state) / (0.5 * bend * curvature * curvature)
}

/// What lacks is a border of about half a cell, whose free edges carry no moment.
#[test]
fn a_cylinder_stores_the_same_about_any_direction_on_any_mesh() {
    for jitter in [0.0, 0.3] {
        for degrees in [0.0, 30.0, 45.0, 90.0, 135.0] {
            let [coarse, fine] = [20, 40].map(|cells| stored(cells, jitter, degrees));
            assert!((0.94..0.99).contains(&coarse), "jitter {jitter}, {degrees}°: {coarse}");
            let lacks = (1.0 - fine) / (1.0 - coarse);
            assert!(lacks < 0.7, "jitter {jitter}, {degrees}°: {coarse}, then {fine}");
        }
    }
}

/// Curvature along the warp costs the warp's stiffness, along the weft the weft's.
#[test]
fn warp_and_weft_bend_as_stiffly_as_they_are() {
    let (faces, positions) = sheet([30; 2], [1.0; 2], 0.2);
    let fabric = Fabric {
        stretch: [0.0; 2],
        compression: [0.0; 2],
        shear: 0.0,
        bend: [2e-3, 5e-4],
        warp: Warp::Along(Vector::x()),
        ..Fabric::default()
    };
    let fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, fabric)]);
    let energy = |degrees: f64| {
        let state = bent(&positions, 0.1, degrees);
        fabrics.energy(0..1, &state)
    };
    let ratio = energy(0.0) / energy(90.0);
    assert!((ratio - 4.0).abs() < 0.12, "{ratio}");
}

#[test]
fn a_pulled_sheet_resists_along_each_yarn_by_its_stiffness() {
    let (faces, positions) = sheet([6, 5], [0.6, 0.5], 0.3);
    let fabric = Fabric { warp: Warp::Along(Vector::x()), ..uneven() };
    let fabrics = Fabrics::new(&[cloth(&faces, positions.clone(), 0.2, fabric)]);
    let energy = |x: f64, y: f64, slide: f64| {
        let moved: Vec<Vector> =
            positions.iter().map(|p| Vector::new(x * p.x + slide * p.y, y * p.y, 0.0)).collect();
        fabrics.energy(0..1, &State::at_rest(&moved)) / (0.6 * 0.5)
    };
    let green = |stretch: f64| 0.5 * (stretch * stretch - 1.0);
    for (stretch, of) in [(1.03, [2000.0, 1200.0]), (0.97, [300.0, 500.0])] {
        let expected = of.map(|stiffness| 0.5 * stiffness * green(stretch).powi(2));
        for (got, expected) in
            [energy(stretch, 1.0, 0.0), energy(1.0, stretch, 0.0)].iter().zip(expected)
        {
            assert!((got / expected - 1.0).abs() < 1e-9, "{stretch}: {got} beside {expected}");
        }
    }
    let slide: f64 = 0.02;
    let expected = 0.5 * 80.0 * slide * slide + 0.5 * 1200.0 * (0.5 * slide * slide).powi(2);
    let got = energy(1.0, 1.0, slide);
    assert!((got / expected - 1.0).abs() < 1e-9, "{got} beside {expected}");
}
