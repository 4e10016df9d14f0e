use super::super::conjugate_gradient::{ConjugateGradient, Stop};
use super::super::laplacian::Forward;
use super::super::problems::{grid, matrix};
use super::*;
use crate::interrupter::Interrupter;
use crate::scatter::scattered;
use crate::state::State;

fn noise(count: usize, seed: u64) -> State {
    let mut state = State::zeros(count);
    for (axis, numbers) in state.position.0.iter_mut().enumerate() {
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = scattered(seed + 3 * i as u64 + axis as u64);
        }
    }
    state
}

/// Iterations of conjugate gradients on the matrix itself, and the error of what they end with.
fn iterations(side: u32, pins: &[usize]) -> (u32, f64) {
    let (positions, pairs) = grid(side, side);
    let count = positions.len();
    let graph = Graph::new(count, &pairs);
    let matrix = matrix(&pairs, count, pins);
    let mut cycle =
        Multigrid::new(&pairs, &matrix, &positions, |particle| pins.contains(&particle));
    let mut exact = noise(count, 7);
    for axis in &mut exact.position.0 {
        for &pin in pins {
            axis[pin] = 0.0;
        }
    }
    let mut x = Field::zeros(count);
    for (to, from) in x.0.iter_mut().zip(&exact.position.0) {
        for (to, from) in to.iter_mut().zip(&**from) {
            *to = *from as f32;
        }
    }
    let mut product = Field::zeros(count);
    matrix.multiply(&graph, &x, &mut product);
    let mut right = State::zeros(count);
    for (to, from) in right.position.0.iter_mut().zip(&product.0) {
        for (to, from) in to.iter_mut().zip(from) {
            *to = f64::from(*from);
        }
    }
    let mut gradients = ConjugateGradient::new(count, &Interrupter::default());
    gradients.start();
    gradients.take_residual(&right.position);
    let stop = Stop { tolerance: 1e-3, least_iterations: 0, most_iterations: 300 };
    let taken =
        gradients.solve(&Forward { graph: &graph, matrix: &matrix }, &mut cycle, stop).iterations;
    let errors = gradients.solution.0[0].iter().zip(&x.0[0]).map(|(a, b)| f64::from(a - b));
    let error = errors.map(|error| error * error).sum::<f64>().sqrt();
    (taken, error / f64::from(side))
}

#[test]
fn a_cycle_solves_large_grids_in_few_iterations_whatever_their_size() {
    for pins in [&[][..], &[0, 77]] {
        for side in [80, 160] {
            let (taken, error) = iterations(side, pins);
            assert!(taken <= 30, "{side}², {pins:?}: {taken} iterations");
            assert!(error < 0.05, "{side}², {pins:?}: {error}");
        }
    }
}

#[test]
fn a_cycle_is_symmetric_and_positive() {
    let (positions, pairs) = grid(90, 70);
    let count = positions.len();
    let matrix = matrix(&pairs, count, &[3]);
    let mut cycle = Multigrid::new(&pairs, &matrix, &positions, |particle| particle == 3);
    let fields = [11, 999_983].map(|seed| {
        let noise = noise(count, seed);
        let mut field = Field::zeros(count);
        for (to, from) in field.0.iter_mut().zip(&noise.position.0) {
            for (to, from) in to.iter_mut().zip(&**from) {
                *to = *from as f32;
            }
        }
        field
    });
    let mut solved = [Field::zeros(count), Field::zeros(count)];
    for (field, solved) in fields.iter().zip(&mut solved) {
        cycle.apply_inverse(field, solved);
    }
    let dot = |a: &Field, b: &Field| -> f64 {
        let pairs = a.0.iter().flatten().zip(b.0.iter().flatten());
        pairs.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    };
    let [a, b] = &fields;
    let size = (dot(a, &solved[0]) * dot(b, &solved[1])).sqrt();
    assert!(dot(a, &solved[0]) > 0.0 && dot(b, &solved[1]) > 0.0);
    let difference = dot(a, &solved[1]) - dot(b, &solved[0]);
    assert!(difference.abs() < 1e-4 * size, "{difference} of {size}");
}
