use nalgebra::{DMatrix, DVector};

use super::super::conjugate_gradient::{ConjugateGradient, Stop};
use super::super::laplacian::Forward;
use super::super::problems::{grid, matrix, noise};
use super::*;
use crate::interrupter::Interrupter;
use crate::scatter::scattered;
use crate::state::State;

/// What the rounding of W to eight bits may change: two units in the last place, relative.
const ROUNDING: f64 = 1.0 / 128.0;

fn dense(graph: &Graph, matrix: &Laplacian) -> DMatrix<f64> {
    let count = matrix.diagonal.len();
    let mut dense = DMatrix::zeros(count, count);
    for i in 0..count {
        dense[(i, i)] = matrix.diagonal[i];
        for (j, weight) in matrix.row(graph, i as u32) {
            dense[(i, j as usize)] = -weight;
        }
    }
    dense
}

fn worst_error(positions: &[Vector], pairs: &[[u32; 2]], pins: &[usize]) -> f64 {
    let count = positions.len();
    let graph = Graph::new(count, pairs);
    let matrix = matrix(pairs, count, pins);
    let mut ldlt = Ldlt::new(&graph, positions, &matrix);
    let r = noise(count);
    let mut z = Field::zeros(count);
    ldlt.apply_inverse(&r, &mut z);
    ldlt.refactor(&graph, &matrix);
    ldlt.apply_inverse(&r, &mut z);
    let lu = dense(&graph, &matrix).lu();
    let errors = (0..3).map(|axis| {
        let b = DVector::from_iterator(count, r.0[axis].iter().map(|&x| f64::from(x)));
        let exact = lu.solve(&b).expect("positive definite");
        let solved = DVector::from_iterator(count, z.0[axis].iter().map(|&x| f64::from(x)));
        (solved - &exact).norm() / exact.norm()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn a_solve_agrees_with_dense_elimination_on_grids_of_any_shape() {
    for (columns, rows) in [(1, 1), (2, 1), (5, 5), (40, 1), (17, 23), (32, 32), (200, 3)] {
        let (positions, pairs) = grid(columns, rows);
        let error = worst_error(&positions, &pairs, &[0]);
        assert!(error < ROUNDING, "{columns} x {rows}: {error}");
    }
}

#[test]
fn a_solve_agrees_with_dense_elimination_where_particles_coincide_or_are_not_joined() {
    let (positions, pairs) = grid(20, 20);
    let one_point = vec![Vector::zeros(); positions.len()];
    let error = worst_error(&one_point, &pairs, &[]);
    assert!(error < ROUNDING, "in one point: {error}");
    let apart: Vec<_> = pairs.iter().copied().filter(|&[a, b]| a / 100 == b / 100).collect();
    let error = worst_error(&positions, &apart, &[7]);
    assert!(error < ROUNDING, "in pieces: {error}");
    let error = worst_error(&positions, &[], &[]);
    assert!(error < 1e-6, "none joined: {error}");
}

#[test]
fn a_solve_agrees_with_dense_elimination_on_a_tangled_graph() {
    let count = 300;
    let mut pairs: Vec<[u32; 2]> = (0..900)
        .map(|i| [0, 1].map(|end| ((0.5 + 0.5 * scattered(2 * i + end)) * 299.99) as u32))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    let positions: Vec<_> = (0..count as u64)
        .map(|i| Vector::from_fn(|axis, _| scattered(1000 + 3 * i + axis as u64)))
        .collect();
    let error = worst_error(&positions, &pairs, &[5, 6]);
    assert!(error < ROUNDING, "{error}");
}

/// Rounding must not tie a pinned particle to its neighbors, however stiff they are.
#[test]
fn a_solve_leaves_pinned_particles_exactly_where_they_are() {
    let (positions, pairs) = grid(24, 24);
    let graph = Graph::new(positions.len(), &pairs);
    let is_pinned = |particle: usize| particle < 24 || particle.is_multiple_of(97);
    let weights = (0..pairs.len() as u64).map(|i| 1e4 * (2.0 + scattered(i))).collect();
    let matrix = Laplacian::new(&pairs, weights, vec![1e-2; positions.len()], is_pinned);
    let mut ldlt = Ldlt::new(&graph, &positions, &matrix);
    let r = noise(positions.len());
    let mut z = Field::zeros(positions.len());
    ldlt.apply_inverse(&r, &mut z);
    for (z, r) in z.0.iter().zip(&r.0) {
        let pinned = (0..positions.len()).filter(|&particle| is_pinned(particle));
        pinned.for_each(|particle| assert_eq!(z[particle].to_bits(), r[particle].to_bits()));
    }
}

/// Cloths of more than one task, the second in two pieces with nothing between them.
#[test]
fn a_solve_of_many_tasks_leaves_little_and_gives_the_same_bits_on_any_number_of_threads() {
    let (columns, rows) = (150, 60);
    let (positions, pairs) = grid(columns, rows);
    let is_left = |particle: u32| particle % columns < columns / 2;
    let apart: Vec<_> = pairs.iter().copied().filter(|&[a, b]| is_left(a) == is_left(b)).collect();
    for pairs in [pairs, apart] {
        let graph = Graph::new(positions.len(), &pairs);
        let matrix = matrix(&pairs, positions.len(), &[3]);
        let r = noise(positions.len());
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let mut z = Field::zeros(positions.len());
            pool.expect("threads").install(|| {
                let mut ldlt = Ldlt::new(&graph, &positions, &matrix);
                assert!(ldlt.workspace.task_count() > 4);
                ldlt.apply_inverse(&r, &mut z);
            });
            z
        });
        let bits =
            |z: &Field| z.0.each_ref().map(|axis| axis.iter().map(|z| z.to_bits()).collect());
        let [one_bits, three_bits]: [[Vec<u32>; 3]; 2] = [&one, &three].map(bits);
        assert!(one_bits == three_bits);
        let mut product = Field::zeros(positions.len());
        matrix.multiply(&graph, &one, &mut product);
        let norm = |of: &dyn Fn(usize, usize) -> f32| {
            let squares = (0..3 * positions.len()).map(|i| f64::from(of(i % 3, i / 3)).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let left =
            norm(&|axis, i| product.0[axis][i] - r.0[axis][i]) / norm(&|axis, i| r.0[axis][i]);
        assert!(left < 2.0 * ROUNDING, "{left}");
    }
}

/// The inverse in f64.
struct Exact(DMatrix<f64>);

impl Inverse for Exact {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        for (z, r) in z.0.iter_mut().zip(&r.0) {
            let r = DVector::from_iterator(r.len(), r.iter().map(|&x| f64::from(x)));
            for (z, solved) in z.iter_mut().zip((&self.0 * r).iter()) {
                *z = *solved as f32;
            }
        }
    }
}

/// Rounding may cost one iteration, even where hardly any inertia holds a cloth in its place.
#[test]
fn conjugate_gradients_need_as_many_iterations_as_with_the_exact_inverse() {
    let (positions, pairs) = grid(27, 23);
    let count = positions.len();
    let graph = Graph::new(count, &pairs);
    let mut state = State::zeros(count);
    for (axis, numbers) in state.position.0.iter_mut().enumerate() {
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = scattered(3 * i as u64 + axis as u64);
        }
    }
    for (inertia, pin) in [(1e-3, None), (1e-6, None), (1e-6, Some(5))] {
        let matrix_of = |seed: u64, spread: f64| {
            let weight = |i| 1.0 + spread * scattered(seed + i);
            let weights = (0..pairs.len() as u64).map(weight).collect();
            Laplacian::new(&pairs, weights, vec![inertia; count], |particle| Some(particle) == pin)
        };
        let matrix = matrix_of(0, 0.3);
        let inverse = dense(&graph, &matrix).cholesky().expect("positive definite").inverse();
        let mut ldlt = Ldlt::new(&graph, &positions, &matrix);
        for (other, tolerance) in [(matrix_of(5000, 0.8), 1e-3), (matrix_of(5000, 0.8), 1e-5)] {
            let iterations = |inverse: &mut dyn Inverse| {
                let mut gradients = ConjugateGradient::new(count, &Interrupter::default());
                gradients.take_residual(&state.position);
                let stop = Stop { tolerance, least_iterations: 0, most_iterations: 100 };
                gradients
                    .solve(&Forward { graph: &graph, matrix: &other }, inverse, stop)
                    .iterations
            };
            let exact = iterations(&mut Exact(inverse.clone()));
            let rounded = iterations(&mut ldlt);
            assert!(rounded <= exact + 1, "inertia {inertia}: {rounded}, exact {exact}");
        }
    }
}

/// 128 x 128 with eight neighbors has 0.54 million numbers in its factor at the least.
#[test]
fn the_factor_of_a_grid_stays_small() {
    let (positions, pairs) = grid(128, 128);
    let graph = Graph::new(positions.len(), &pairs);
    let matrix = matrix(&pairs, positions.len(), &[]);
    let size = Ldlt::new(&graph, &positions, &matrix).size();
    assert!(size < 1_100_000, "{size}");
}
