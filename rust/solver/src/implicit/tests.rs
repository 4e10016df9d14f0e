//! The matrix of an implicit step against the derivative of its residual, and against the preconditioner.
//!
//! Wind is left out: its entries in the matrix are a bound of its derivative by design, not the derivative.

use boucle_geometry::{Mesh, Vector};

use super::factored::Factored;
use super::preconditioner::Preconditioner;
use super::smoothed::Smoothed;
use super::*;
use crate::cloth::Mass;
use crate::linear::{Field, Inverse, LARGEST, Operator};
use crate::material::{DampingLaw, Limiter, SpringKind, SpringMaterial};
use crate::scatter::scattered;
use crate::state::Coordinates;

/// Columns and rows, and a step (s).
const SIZE: [u32; 2] = [23, 17];
const H: f64 = 1.0 / 150.0;

/// The matrix is kept in f32, 6e-8 a number, and a row sums up to 24 springs.
const SINGLE: f64 = 1e-6;

/// Errors of a preconditioner do not matter to the solution.
const SMOOTHED: f64 = 1e-3;

/// A vector for each particle.
type Vectors = Vec<Vector>;

fn noise(seed: u64, count: usize) -> Vectors {
    let number = |i: usize, axis: usize| scattered(seed * 1_000_003 + 3 * i as u64 + axis as u64);
    (0..count).map(|i| Vector::from_fn(|axis, _| number(i, axis))).collect()
}

/// Waves of a few lengths and directions.
fn smooth(seed: u64, positions: &[Vector]) -> Vectors {
    let [a, b, c] = [0, 1, 2].map(|k| 3.0 * scattered(31 * seed + k));
    let wave = |x: &Vector| (a * x.x + b * x.y + c).sin();
    positions.iter().map(|x| wave(x) * Vector::new(1.0, a, c)).collect()
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn norm(a: &[Vector]) -> f64 {
    dot(a, a).sqrt()
}

/// A sheet with two pins. With names in order its springs lie on diagonals, else they are gathered.
fn sheet(is_in_order: bool, material: &SpringMaterial) -> Cloth {
    let [columns, rows] = SIZE;
    let count = columns * rows;
    let mut names: Vec<u32> = (0..count).collect();
    if !is_in_order {
        names.sort_by(|&a, &b| scattered(u64::from(a)).total_cmp(&scattered(u64::from(b))));
    }
    let name = |i: u32| names[i as usize];
    let at = |c: u32, r: u32| name(r * columns + c);
    let faces: Vec<[u32; 4]> = (0..rows - 1)
        .flat_map(|r| (0..columns - 1).map(move |c| (c, r)))
        .map(|(c, r)| [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)])
        .collect();
    let mut positions = vec![Vector::zeros(); count as usize];
    for i in 0..count {
        let (c, r) = (f64::from(i % columns), f64::from(i / columns));
        // No two springs of a kind are equally long.
        let uneven = Vector::new(scattered(7 * u64::from(i)), scattered(7 * u64::from(i) + 1), 0.0);
        positions[name(i) as usize] = 0.05 * (Vector::new(c, r, 0.0) + 0.05 * uneven);
    }
    let mesh = Mesh::from_faces(count as usize, &faces).expect("a sheet");
    let pins = vec![at(0, rows - 1), at(columns - 1, rows - 1)];
    Cloth::from_mesh("sheet", mesh, positions, &Mass::Density(0.2), material.clone(), pins)
        .expect("a sheet")
}

/// A step in the making, in which the state before may be anything.
struct Making {
    cloths: Vec<Cloth>,
    system: System,
    implicit: Implicit,
    contacts: Contacts,
    base: Vectors,
}

impl Making {
    /// With the velocity that the particles have at some positions.
    fn new(cloth: Cloth, positions: &[Vector], velocities: &[Vector]) -> Self {
        Self::of(vec![cloth], positions, velocities)
    }

    /// The same of several cloths.
    fn of(cloths: Vec<Cloth>, positions: &[Vector], velocities: &[Vector]) -> Self {
        let mut system = System::new(&cloths, Vec::new(), None, Vector::new(0.0, 0.0, -9.81));
        for pin in pins(&cloths) {
            system.set_pinned(pin, true);
        }
        let state = State::at_rest(positions);
        let rule = Rule::ImplicitEuler;
        let interrupter = Interrupter::default();
        let mut implicit =
            Implicit::new(rule, LinearSolver::Ldlt, &cloths, &system, &state, &interrupter);
        implicit.follow_pins(&system);
        let base = positions.iter().zip(velocities).map(|(x, v)| x - H * v).collect();
        let contacts = Contacts::new(&cloths, &[], &interrupter);
        Self { cloths, system, implicit, contacts, base }
    }

    /// What the forces leave at some positions (N), with the tangents there.
    fn residual(&mut self, positions: &[Vector]) -> Vectors {
        for (i, (x, base)) in positions.iter().zip(&self.base).enumerate() {
            self.implicit.at.position.set(i, x);
            self.implicit.at.velocity.set(i, &((x - base) / H));
            self.implicit.base.position.set(i, base);
            self.implicit.base.velocity.set(i, base);
        }
        self.implicit.linearize(&self.system, &mut self.contacts, H, H);
        let Implicit { hessian, blocks, .. } = &mut self.implicit;
        hessian.invert_blocks(&self.system, &self.contacts.matrix, blocks);
        vectors(&self.implicit.residual.position)
    }

    /// The product with the matrix frozen at the last positions.
    fn product(&self, vectors: &[Vector]) -> Vectors {
        let Self { system, implicit, contacts, .. } = self;
        apply(&implicit.hessian.on(system, &contacts.matrix), vectors)
    }

    /// What the preconditioner of the step makes of a direction.
    fn precondition(&mut self, direction: &[Vector]) -> Vectors {
        let Self { system, implicit, contacts, .. } = self;
        let Implicit { preconditioner, hessian, blocks, scratch, .. } = implicit;
        let matrix = &hessian.without_bends(system, &contacts.matrix);
        let inverse = preconditioner.inverse(system, H);
        let contacts = &contacts.matrix;
        let mut smoothed = Smoothed {
            matrix,
            contacts: Some(contacts),
            blocks,
            inverse,
            largest: hessian.largest(),
            scratch,
        };
        let mut z = Field::zeros(direction.len());
        smoothed.apply_inverse(&field(direction), &mut z);
        vectors_of(&z)
    }

    /// The largest eigenvalue of B⁻¹ H, by power iteration from a direction.
    fn largest_of_blocks(&self, direction: &[Vector]) -> f64 {
        let mut x = direction.to_vec();
        let mut largest = 0.0;
        for _ in 0..60 {
            let Self { system, implicit, contacts, .. } = self;
            let matrix = implicit.hessian.without_bends(system, &contacts.matrix);
            let product = field(&apply(&matrix, &x));
            let [mut step, mut z] = [(); 2].map(|()| Field::zeros(x.len()));
            self.implicit.blocks.relax([0.0, 1.0], &product, &mut step, &mut z);
            let next = vectors_of(&z);
            largest = norm(&next) / norm(&x);
            x = next.iter().map(|z| z / norm(&next)).collect();
        }
        largest
    }

    /// The difference quotient of the residual along a direction (N/m), its sign turned.
    fn slope(&mut self, positions: &[Vector], direction: &[Vector]) -> Vectors {
        let e = 1e-8;
        let mut residual_at = |e: f64| {
            let moved: Vectors = positions.iter().zip(direction).map(|(x, d)| x + e * d).collect();
            self.residual(&moved)
        };
        let [ahead, behind] = [e, -e].map(&mut residual_at);
        behind.iter().zip(&ahead).map(|(behind, ahead)| (behind - ahead) / (2.0 * e)).collect()
    }

    /// A direction in which the particles can move.
    fn freed(&self, mut direction: Vectors) -> Vectors {
        for pin in pins(&self.cloths) {
            direction[pin] = Vector::zeros();
        }
        direction
    }

    /// Directions of all kinds.
    fn directions(&self) -> Vec<Vectors> {
        let positions: &Vectors =
            &self.cloths.iter().flat_map(|cloth| cloth.positions.clone()).collect();
        let kinds = (0..6).map(|seed| match seed % 2 {
            0 => noise(seed, positions.len()),
            _ => smooth(seed, positions),
        });
        kinds.map(|direction| self.freed(direction)).collect()
    }
}

fn pins(cloths: &[Cloth]) -> impl Iterator<Item = usize> {
    placed(cloths).flat_map(|(cloth, base)| cloth.pins.iter().map(move |pin| (base + pin) as usize))
}

fn vectors(coordinates: &Coordinates) -> Vectors {
    (0..coordinates.0[0].len()).map(|i| coordinates.get(i)).collect()
}

fn field(vectors: &[Vector]) -> Field {
    let mut field = Field::zeros(vectors.len());
    for (axis, numbers) in field.0.iter_mut().enumerate() {
        for (number, vector) in numbers.iter_mut().zip(vectors) {
            *number = vector[axis] as f32;
        }
    }
    field
}

fn vectors_of(field: &Field) -> Vectors {
    let count = field.0[0].len();
    (0..count).map(|i| Vector::from_fn(|axis, _| f64::from(field.0[axis][i]))).collect()
}

fn apply(operator: &impl Operator, vectors: &[Vector]) -> Vectors {
    let mut out = Field::zeros(vectors.len());
    operator.apply(&field(vectors), &mut out);
    vectors_of(&out)
}

/// Positions drawn out by a factor and moved about by a part of an edge.
fn drawn(cloth: &Cloth, factor: f64, shake: f64, seed: u64) -> Vectors {
    let noise = noise(seed, cloth.positions.len());
    cloth.positions.iter().zip(&noise).map(|(x, n)| factor * x + 0.05 * shake * n).collect()
}

/// All springs that a material may have.
fn materials(limiter: Limiter) -> Vec<SpringMaterial> {
    let base = SpringMaterial {
        stiffness: [500.0, 100.0, 20.0],
        air_damping: 1e-3,
        limiter,
        ..SpringMaterial::default()
    };
    let with = |damping: f64, damping_law: DampingLaw| SpringMaterial {
        damping: [damping, 0.5 * damping, 0.1 * damping],
        damping_law,
        ..base.clone()
    };
    vec![
        with(0.0, DampingLaw::Relative),
        with(0.3, DampingLaw::Relative),
        with(0.3, DampingLaw::Axial),
    ]
}

/// Length of each spring relative to that at rest.
fn ratios(cloth: &Cloth, positions: &[Vector]) -> Vec<f64> {
    let springs = cloth.springs.iter();
    let ratios = springs.map(|spring| {
        let [a, b] = spring.ends.map(|end| positions[end as usize]);
        (a - b).norm() / spring.rest_length
    });
    ratios.collect()
}

/// Whether a spring is about as long as at rest, or as it is allowed to be.
fn is_near_kink(cloth: &Cloth, positions: &[Vector]) -> bool {
    let kinks = [1.0, 1.0 + cloth.material.deformation_rate];
    let mut distances = ratios(cloth, positions).into_iter().flat_map(|r| kinks.map(|k| r - k));
    distances.any(|distance| distance.abs() < 2e-6)
}

/// The parts of a cloth's springs that are shorter than at rest, and that are longer than allowed.
fn parts(cloth: &Cloth, positions: &[Vector]) -> [f64; 2] {
    let ratios = ratios(cloth, positions);
    let part = |is_meant: &dyn Fn(f64) -> bool| {
        ratios.iter().filter(|&&ratio| is_meant(ratio)).count() as f64 / ratios.len() as f64
    };
    [part(&|ratio| ratio < 1.0), part(&|ratio| ratio > 1.0 + cloth.material.deformation_rate)]
}

/// What the clamp leaves out along a direction (N/m): the tension of springs shorter than at rest, across them.
fn left_out(cloth: &Cloth, positions: &[Vector], direction: &[Vector]) -> Vectors {
    let mut out = vec![Vector::zeros(); positions.len()];
    for spring in &cloth.springs {
        let [a, b] = spring.ends.map(|end| end as usize);
        let span = positions[a] - positions[b];
        let push = spring.stiffness * (spring.rest_length / span.norm() - 1.0);
        if push > 0.0 {
            let normal = span.normalize();
            let d = direction[a] - direction[b];
            let across = push * (d - normal * normal.dot(&d));
            out[a] += across;
            out[b] -= across;
        }
    }
    for &pin in &cloth.pins {
        out[pin as usize] = Vector::zeros();
    }
    out
}

/// Compares the matrix with the derivative for each material, layout and direction.
fn compare(
    limiter: Limiter,
    factor: f64,
    shake: f64,
    speed: f64,
    expected: &[std::ops::Range<f64>; 2],
) {
    for material in materials(limiter) {
        for is_in_order in [true, false] {
            let cloth = sheet(is_in_order, &material);
            // A kink within reach of the difference would be no error: another try.
            let positions = (100..120)
                .map(|seed| drawn(&cloth, factor, shake, seed))
                .find(|positions| !is_near_kink(&cloth, positions))
                .expect("away from kinks");
            let parts = parts(&cloth, &positions);
            for (part, expected) in parts.iter().zip(expected) {
                assert!(expected.contains(part), "shorter, too long: {parts:?}");
            }
            // Axial damping turns with its spring, which the matrix leaves out: then nothing moves.
            let is_axial = material.damping_law == DampingLaw::Axial;
            let speed = if is_axial { 0.0 } else { speed };
            let velocities: Vectors =
                noise(9, positions.len()).iter().map(|noise| speed * noise).collect();
            let mut making = Making::new(cloth.clone(), &positions, &velocities);
            assert_eq!(making.system.layout.diagonals.is_empty(), !is_in_order);
            for (number, direction) in making.directions().into_iter().enumerate() {
                let slope = making.slope(&positions, &direction);
                making.residual(&positions);
                let product = making.product(&direction);
                let clamped = left_out(&cloth, &positions, &direction);
                let error = (0..slope.len()).map(|i| product[i] - clamped[i] - slope[i]);
                let error = norm(&error.collect::<Vectors>()) / norm(&slope);
                assert!(
                    error < SINGLE,
                    "{material:?}, {is_in_order}, direction {number}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn the_matrix_is_the_derivative_of_the_residual_where_all_springs_are_stretched() {
    compare(Limiter::None, 1.3, 0.1, 2.0, &[0.0..1e-9, 0.5..1.1]);
}

/// Some below the length from which equation 6 stiffens, some beyond it.
#[test]
fn the_matrix_is_the_derivative_of_the_residual_of_equation_six() {
    compare(Limiter::Stiffen, 1.1, 0.03, 2.0, &[0.0..1e-9, 0.2..0.8]);
}

/// Edges beyond their allowed length pull with a tension of their own.
#[test]
fn the_matrix_is_the_derivative_of_the_residual_with_edges_held_at_their_allowed_length() {
    compare(Limiter::Project, 1.1, 0.03, 2.0, &[0.0..1e-9, 0.2..0.8]);
}

/// Of a spring that is shorter than at rest the matrix has the stiffness along it. Across it, where it would buckle, the
/// derivative is negative and left out: put back by hand, the two are equal.
#[test]
fn the_matrix_is_the_derivative_but_for_the_buckling_of_compressed_springs() {
    for limiter in [Limiter::None, Limiter::Stiffen, Limiter::Project] {
        compare(limiter, 0.95, 0.4, 2.0, &[0.4..0.9, 0.01..0.6]);
    }
}

/// States from crushed to drawn far out.
const STATES: [(f64, f64); 4] = [(0.2, 0.1), (0.95, 0.5), (1.0, 3.0), (1.5, 0.2)];

#[test]
fn the_matrix_is_symmetric_and_positive_in_any_state() {
    for limiter in [Limiter::None, Limiter::Stiffen, Limiter::Project] {
        for material in materials(limiter) {
            for ((factor, shake), is_in_order) in STATES.into_iter().zip([true, false, true, false])
            {
                let cloth = sheet(is_in_order, &material);
                let positions = drawn(&cloth, factor, shake, 5);
                let velocities = noise(9, positions.len());
                let mut making = Making::new(cloth, &positions, &velocities);
                making.residual(&positions);
                let directions = making.directions();
                let products: Vec<Vectors> =
                    directions.iter().map(|direction| making.product(direction)).collect();
                for (x, hx) in directions.iter().zip(&products) {
                    // At least the inertia.
                    let inertia = making.implicit.hessian.inertia.iter().zip(x);
                    let least: f64 = inertia.map(|(m, x)| f64::from(*m) * x.norm_squared()).sum();
                    assert!(dot(x, hx) > (1.0 - SINGLE) * least, "{limiter:?}, {factor}");
                    for (y, hy) in directions.iter().zip(&products) {
                        let size = (dot(x, hx) * dot(y, hy)).sqrt();
                        let difference = (dot(x, hy) - dot(y, hx)) / size;
                        assert!(difference.abs() < SINGLE, "{limiter:?}, {factor}: {difference:e}");
                    }
                }
            }
        }
    }
}

/// `xᵀ H x <= xᵀ P x`, with the bend springs that P leaves out added to it; and it is nearly reached.
#[test]
fn the_preconditioner_is_never_below_the_matrix_of_hookean_springs() {
    for material in materials(Limiter::None) {
        for ((factor, shake), is_in_order) in STATES.into_iter().zip([false, true, false, true]) {
            let cloth = sheet(is_in_order, &material);
            let positions = drawn(&cloth, factor, shake, 5);
            let mut making = Making::new(cloth.clone(), &positions, &noise(9, positions.len()));
            making.residual(&positions);
            let mut preconditioner =
                Preconditioner::new(&making.cloths, &making.system.fabrics, LinearSolver::Ldlt);
            preconditioner.inverse(&making.system, H);
            let matrix = preconditioner.both(&making.system, H).1;
            for direction in making.directions() {
                let bends = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Bend);
                let bend: f64 = bends
                    .map(|spring| {
                        let [a, b] = spring.ends.map(|end| direction[end as usize]);
                        (spring.stiffness + spring.damping / H) * (a - b).norm_squared()
                    })
                    .sum();
                let most = dot(&direction, &apply(&matrix, &direction)) + bend;
                let part = dot(&direction, &making.product(&direction)) / most;
                assert!(part <= 1.0 + SINGLE, "{material:?}, {factor}: {part}");
                assert!(part > 0.1, "{material:?}, {factor}: {part}");
            }
        }
    }
}

/// Also of the blocks: `B⁻¹ H` has no eigenvalue above the one that the smoothing is made for.
#[test]
fn the_smoothed_preconditioner_is_symmetric_and_positive_in_any_state() {
    for limiter in [Limiter::None, Limiter::Stiffen, Limiter::Project] {
        for material in materials(limiter) {
            for ((factor, shake), is_in_order) in STATES.into_iter().zip([true, false, false, true])
            {
                let cloth = sheet(is_in_order, &material);
                let positions = drawn(&cloth, factor, shake, 5);
                let mut making = Making::new(cloth, &positions, &noise(9, positions.len()));
                making.residual(&positions);
                let directions = making.directions();
                let largest = making.largest_of_blocks(&directions[0]);
                assert!(largest < f64::from(LARGEST) + 1e-3, "{limiter:?}, {factor}: {largest}");
                let products: Vec<Vectors> =
                    directions.iter().map(|direction| making.precondition(direction)).collect();
                for (x, zx) in directions.iter().zip(&products) {
                    assert!(dot(x, zx) > 0.0, "{limiter:?}, {factor}");
                    for (y, zy) in directions.iter().zip(&products) {
                        let size = (dot(x, zx) * dot(y, zy)).sqrt();
                        let difference = (dot(x, zy) - dot(y, zx)) / size;
                        assert!(
                            difference.abs() < SMOOTHED,
                            "{limiter:?}, {factor}: {difference:e}"
                        );
                    }
                }
            }
        }
    }
}

/// A sheet of fabric; its faces' angles at rest are what the seed makes of them.
fn of_fabric(positions: &[Vector], damping_ratio: f64) -> Cloth {
    of_bending_fabric(positions, damping_ratio, [2e-3, 1e-3])
}

fn of_bending_fabric(positions: &[Vector], damping_ratio: f64, bend: [f64; 2]) -> Cloth {
    let cloth =
        sheet(true, &SpringMaterial { limiter: Limiter::None, ..SpringMaterial::default() });
    let fabric = crate::Fabric {
        stretch: [900.0, 500.0],
        compression: [200.0, 100.0],
        shear: 60.0,
        bend,
        damping_ratio: [damping_ratio; 3],
        warp: crate::Warp::Along(Vector::new(0.4, 1.0, 0.0)),
        ..crate::Fabric::default()
    };
    Cloth { positions: positions.to_vec(), ..cloth }.of_fabric(fabric).expect("a fabric")
}

/// Where all triangles are drawn and no hinge is turned, nothing is left out of the tangents.
#[test]
fn the_matrix_of_drawn_fabric_is_the_derivative_of_the_residual() {
    for damping_ratio in [0.0, 0.3] {
        let flat = sheet(true, &SpringMaterial::default()).positions;
        let cloth = of_fabric(&flat, damping_ratio);
        // Drawn and sheared evenly, and turned out of the plane: every triangle pulls, and all lie in one plane.
        let positions: Vectors = flat
            .iter()
            .map(|x| Vector::new(1.05 * x.x + 0.02 * x.y, 1.03 * x.y, 0.3 * x.x - 0.2 * x.y))
            .collect();
        // Damping is no part of the derivative in positions alone where the velocity changes the stress itself.
        let mut making = Making::new(cloth, &positions, &vec![Vector::zeros(); flat.len()]);
        for direction in making.directions() {
            let slope = making.slope(&positions, &direction);
            making.residual(&positions);
            let product = making.product(&direction);
            let error: Vectors = slope.iter().zip(&product).map(|(a, b)| a - b).collect();
            let error = norm(&making.freed(error)) / norm(&product);
            assert!(error < 1e-5, "damping ratio {damping_ratio}: {error:e}");
        }
    }
}

#[test]
fn matrix_and_preconditioner_of_crumpled_fabric_are_symmetric_and_positive() {
    let flat = sheet(true, &SpringMaterial::default()).positions;
    for shake in [0.0, 0.2, 0.6] {
        let cloth = of_fabric(&flat, 0.1);
        let positions: Vectors = flat
            .iter()
            .zip(noise(3, flat.len()))
            .map(|(x, n)| 0.97 * x + 0.05 * shake * n)
            .collect();
        let mut making = Making::new(cloth, &positions, &noise(4, flat.len()));
        making.residual(&positions);
        let directions = making.directions();
        for pair in directions.windows(2) {
            let [a, b] = [&pair[0], &pair[1]];
            let of_matrix = [making.product(a), making.product(b)];
            let of_inverse = [making.precondition(a), making.precondition(b)];
            for ([one, other], tolerance) in [(of_matrix, SINGLE), (of_inverse, SMOOTHED)] {
                let scale = (dot(a, &one) * dot(b, &other)).sqrt();
                assert!(dot(a, &one) > 0.0 && dot(b, &other) > 0.0, "shake {shake}");
                let error = (dot(b, &one) - dot(a, &other)).abs() / scale;
                assert!(error < tolerance, "shake {shake}: {error:e}");
            }
        }
    }
}

/// What the factored matrix makes of `H x` is x, for springs in any order, for fabric, and for both side by side, in any state.
#[test]
fn the_factored_inverse_is_that_of_the_matrix_without_what_bends() {
    let [material, ..] = &materials(Limiter::Project)[..] else { panic!("no material") };
    let fabric = of_bending_fabric(&sheet(true, material).positions, 0.1, [0.0; 2]);
    let [in_order, gathered] = [true, false].map(|is_in_order| sheet(is_in_order, material));
    for (factor, shake) in STATES {
        for cloths in [
            vec![in_order.clone()],
            vec![gathered.clone()],
            vec![fabric.clone()],
            vec![gathered.clone(), fabric.clone(), in_order.clone()],
        ] {
            let positions: Vectors =
                cloths.iter().flat_map(|cloth| drawn(cloth, factor, shake, 5)).collect();
            let mut making = Making::of(cloths, &positions, &noise(9, positions.len()));
            making.residual(&positions);
            let mut factored = Factored::new(&making.implicit.preconditioner, &making.system);
            let hessian = &making.implicit.hessian;
            let contacts = &making.contacts.matrix;
            let inverse = factored.inverse(hessian, &making.system, contacts);
            for direction in making.directions() {
                let hx = apply(&hessian.without_bends(&making.system, contacts), &direction);
                let mut z = Field::zeros(hx.len());
                inverse.apply_inverse(&field(&hx), &mut z);
                let error: Vectors =
                    vectors_of(&z).iter().zip(&direction).map(|(a, b)| a - b).collect();
                let error = norm(&error) / norm(&direction);
                assert!(error < SMOOTHED, "{factor}, {shake}: {error:e}");
            }
        }
    }
}
