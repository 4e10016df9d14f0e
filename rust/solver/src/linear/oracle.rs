//! The direct solver against another program's sparse `LDLᵀ`, and against conjugate gradients run to convergence.
//!
//! The other program is `sprs-ldl`, after LDL, Copyright (c) 2005 by Timothy A. Davis, used by permission.

use boucle_geometry::Vector;
use sprs::{CsMat, TriMat};
use sprs_ldl::Ldl;

use super::problems::{grid, matrix};
use super::{ConjugateGradient, Field, Forward, Graph, Inverse, Laplacian, Ldlt, Multigrid, Stop};
use crate::interrupter::Interrupter;
use crate::scatter::scattered;
use crate::state::State;

/// How far a solve may be from one in f64, relative to its norm: a large part of the factor is stored in bf16, whose
/// numbers are off by up to 1/256.
const ERROR_OF_STORE: f64 = 1.0 / 128.0;

/// The same after [`REFINEMENTS`] solves of what is left.
const ERROR_REFINED: f64 = 1e-6;
const REFINEMENTS: usize = 4;

/// Positions, pairs and pins of a problem.
struct Problem {
    name: &'static str,
    positions: Vec<Vector>,
    pairs: Vec<[u32; 2]>,
    pins: Vec<usize>,
}

impl Problem {
    fn new(
        name: &'static str,
        (positions, pairs): (Vec<Vector>, Vec<[u32; 2]>),
        pins: &[usize],
    ) -> Self {
        Self { name, positions, pairs, pins: pins.to_vec() }
    }

    fn count(&self) -> usize {
        self.positions.len()
    }

    fn graph(&self) -> Graph {
        Graph::new(self.count(), &self.pairs)
    }

    fn matrix(&self) -> Laplacian {
        matrix(&self.pairs, self.count(), &self.pins)
    }
}

/// Triangles between points moved about by a third of a cell, with diagonals either way and a hole of any shape.
fn triangles(side: u32) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let noise = |i: u32, k: u64| scattered(5 * u64::from(i) + k);
    let middle = f64::from(side) / 2.0;
    let positions: Vec<Vector> = (0..side * side)
        .map(|i| {
            let (x, y) = (f64::from(i % side), f64::from(i / side));
            Vector::new(x + 0.33 * noise(i, 0), y + 0.33 * noise(i, 1), 0.3 * noise(i, 2))
        })
        .collect();
    let is_there = |i: u32| (positions[i as usize] - Vector::new(middle, middle, 0.0)).norm() > 4.0;
    let mut pairs = Vec::new();
    for (r, c) in (0..side - 1).flat_map(|r| (0..side - 1).map(move |c| (r, c))) {
        let [a, b, d, e] =
            [r * side + c, r * side + c + 1, (r + 1) * side + c, (r + 1) * side + c + 1];
        let diagonal = if noise(a, 3) > 0.0 { [a, e] } else { [b, d] };
        pairs.extend([[a, b], [a, d], diagonal]);
        if r + 2 == side {
            pairs.push([d, e]);
        }
        if c + 2 == side {
            pairs.push([b, e]);
        }
    }
    pairs.retain(|pair| pair.iter().all(|&end| is_there(end)));
    (positions, pairs)
}

/// Sheets beside each other that share nothing, and single particles.
fn pieces() -> (Vec<Vector>, Vec<[u32; 2]>) {
    let (mut positions, mut pairs) = (Vec::new(), Vec::new());
    for (number, (columns, rows)) in [(20, 20), (1, 1), (9, 31), (40, 1), (1, 1)].iter().enumerate()
    {
        let base = positions.len() as u32;
        let (points, linked) = grid(*columns, *rows);
        // The second and third lie among each other.
        let shift = Vector::new(7.0 * number as f64, 0.5, 0.0);
        positions.extend(points.iter().map(|point| point + shift));
        pairs.extend(linked.iter().map(|pair| pair.map(|end| base + end)));
    }
    (positions, pairs)
}

fn path(count: u32) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let turn = |i: u32| f64::from(i) * 0.1;
    let positions = (0..count).map(|i| Vector::new(turn(i).cos(), turn(i).sin(), turn(i)));
    (positions.collect(), (1..count).map(|i| [i - 1, i]).collect())
}

fn star(count: u32) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let ray = |i: u32| Vector::from_fn(|axis, _| scattered(u64::from(3 * i) + axis as u64));
    ((0..count).map(ray).collect(), (1..count).map(|i| [0, i]).collect())
}

fn problems() -> Vec<Problem> {
    vec![
        Problem::new("grid", grid(60, 45), &[]),
        Problem::new("grid of two pins", grid(48, 48), &[0, 47]),
        Problem::new("triangles", triangles(40), &[]),
        Problem::new("triangles with pins", triangles(40), &[3, 40, 1599]),
        Problem::new("pieces", pieces(), &[0, 19, 400, 600]),
        Problem::new("path", path(700), &[]),
        Problem::new("path with pins", path(700), &[0, 350, 699]),
        Problem::new("star", star(300), &[]),
        Problem::new("star held in its middle", star(300), &[0]),
        Problem::new("star held at its rays", star(300), &[7, 8]),
    ]
}

fn sparse(graph: &Graph, matrix: &Laplacian) -> CsMat<f64> {
    let count = matrix.diagonal.len();
    let mut triplets = TriMat::new((count, count));
    for i in 0..count {
        triplets.add_triplet(i, i, matrix.diagonal[i]);
        for (j, weight) in matrix.row(graph, i as u32) {
            triplets.add_triplet(i, j as usize, -weight);
        }
    }
    triplets.to_csc()
}

/// A right-hand side. A particle that nothing joins would answer with a thousand times what the others do, and hide
/// them in the norm: it is pushed so much less.
fn noise(graph: &Graph) -> Field {
    let push = |i: u32| if graph.neighbors(i).is_empty() { 1e-3 } else { 1.0 };
    Field(std::array::from_fn(|axis| {
        let number = |i: u32| push(i) * scattered(u64::from(3 * i) + axis as u64);
        (0..graph.particle_count() as u32).map(|i| number(i) as f32).collect()
    }))
}

fn wide(numbers: &[f32]) -> Vec<f64> {
    numbers.iter().map(|&number| f64::from(number)).collect()
}

/// The largest difference over the axes, relative to the norm of the second.
fn difference(ours: &[Vec<f64>; 3], theirs: &[Vec<f64>; 3]) -> f64 {
    let differences = ours.iter().zip(theirs).map(|(ours, theirs)| {
        let squares = ours.iter().zip(theirs).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / theirs.iter().map(|b| b * b).sum::<f64>()).sqrt()
    });
    differences.fold(0.0, f64::max)
}

/// `r - P x`.
fn left(graph: &Graph, matrix: &Laplacian, r: &Field, x: &[Vec<f64>; 3]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| {
        let x = &x[axis];
        let product = |i: usize| {
            let others = matrix.row(graph, i as u32);
            let others = others.map(|(j, weight)| weight * x[j as usize]);
            matrix.diagonal[i] * x[i] - others.sum::<f64>()
        };
        r.0[axis].iter().enumerate().map(|(i, r)| f64::from(*r) - product(i)).collect()
    })
}

fn narrow(numbers: &[Vec<f64>; 3]) -> Field {
    Field(numbers.each_ref().map(|axis| axis.iter().map(|&number| number as f32).collect()))
}

fn add(to: &mut [Vec<f64>; 3], step: &Field) {
    for (to, step) in to.iter_mut().zip(&step.0) {
        for (to, step) in to.iter_mut().zip(step) {
            *to += f64::from(*step);
        }
    }
}

#[test]
fn a_solve_agrees_with_the_sparse_elimination_of_another_program() {
    for problem in problems() {
        let (graph, matrix) = (problem.graph(), problem.matrix());
        let r = noise(&graph);
        let mut ldlt = Ldlt::new(&graph, &problem.positions, &matrix);
        let mut z = Field::zeros(problem.count());
        ldlt.apply_inverse(&r, &mut z);
        let theirs = Ldl::new().numeric(sparse(&graph, &matrix).view()).expect("positive definite");
        let exact = r.0.each_ref().map(|axis| theirs.solve(&wide(axis)));
        let error = difference(&z.0.each_ref().map(|axis| wide(axis)), &exact);
        assert!(error < ERROR_OF_STORE, "{}: {error:e}", problem.name);
        let mut refined = z.0.each_ref().map(|axis| wide(axis));
        for _ in 0..REFINEMENTS {
            ldlt.apply_inverse(&narrow(&left(&graph, &matrix, &r, &refined)), &mut z);
            add(&mut refined, &z);
        }
        let error = difference(&refined, &exact);
        assert!(error < ERROR_REFINED, "{}: {error:e}", problem.name);
    }
}

/// Conjugate gradients in f32 settle at the rounding of the matrix times its condition: each round of them takes up
/// what the one before left, in f64.
const ROUNDS: usize = 4;

#[test]
fn a_solve_agrees_with_conjugate_gradients_behind_a_multigrid_cycle() {
    for (side, pins) in [(80, &[][..]), (96, &[0, 95])] {
        let problem = Problem::new("grid", grid(side, side), pins);
        let (graph, matrix, count) = (problem.graph(), problem.matrix(), problem.count());
        let r = noise(&graph);
        let mut z = Field::zeros(count);
        Ldlt::new(&graph, &problem.positions, &matrix).apply_inverse(&r, &mut z);
        let is_pinned = |particle: usize| pins.contains(&particle);
        let mut cycle = Multigrid::new(&problem.pairs, &matrix, &problem.positions, is_pinned);
        let mut gradients = ConjugateGradient::new(count, &Interrupter::default());
        let stop = Stop { tolerance: 1e-4, least_iterations: 0, most_iterations: 200 };
        let mut solution = [0, 1, 2].map(|_| vec![0.0; count]);
        for _ in 0..ROUNDS {
            gradients.start();
            let left = left(&graph, &matrix, &r, &solution);
            let mut right = State::zeros(count);
            for (to, from) in right.position.0.iter_mut().zip(&left) {
                to.copy_from_slice(from);
            }
            gradients.take_residual(&right.position);
            let solved =
                gradients.solve(&Forward { graph: &graph, matrix: &matrix }, &mut cycle, stop);
            assert!(solved.iterations < stop.most_iterations, "{side}², {pins:?}");
            add(&mut solution, &gradients.solution);
        }
        let error = difference(&z.0.each_ref().map(|axis| wide(axis)), &solution);
        assert!(error < ERROR_OF_STORE, "{side}², {pins:?}: {error:e}");
    }
}
