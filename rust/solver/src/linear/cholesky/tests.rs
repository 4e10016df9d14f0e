use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::super::problems::{grid, noise};
use super::*;
use crate::scatter::scattered;

/// A matrix, and what each particle has at least on its diagonal.
type Problem = (BlockMatrix, Vec<f32>);

/// Pairs that resist along their own directions more than across, with a skew part, and uneven inertia.
fn problem(pairs: &[[u32; 2]], count: usize, pins: &[usize], inertia: f32) -> Problem {
    let is_pinned = |particle: u32| pins.contains(&(particle as usize));
    let mut blocks = vec![Matrix3::<f32>::identity() * inertia; count];
    let mut numbers = Vec::new();
    for (pair, &[a, b]) in pairs.iter().enumerate() {
        let seed = 7 * pair as u64;
        let n = Vector3::from_fn(|axis, _| scattered(seed + axis as u64) as f32).normalize();
        let even = n * n.transpose() + Matrix3::identity() * 0.05;
        for end in [a, b].into_iter().filter(|end| !is_pinned(*end)) {
            blocks[end as usize] += even;
        }
        let block = if is_pinned(a) || is_pinned(b) { Matrix3::zeros() } else { even };
        numbers.push(std::array::from_fn(|i| block[(i / 3, i % 3)]));
    }
    let least = (0..count as u32).map(|i| if is_pinned(i) { 0.0 } else { inertia }).collect();
    for &pin in pins {
        blocks[pin] = Matrix3::identity();
    }
    let entry = |row: usize, column: usize| blocks.iter().map(|b| b[(row, column)]).collect();
    let diagonal =
        [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)].map(|(row, column)| entry(row, column));
    (BlockMatrix { diagonal, pairs: numbers }, least)
}

fn dense(pairs: &[[u32; 2]], matrix: &BlockMatrix) -> DMatrix<f64> {
    let count = matrix.diagonal[0].len();
    let mut dense = DMatrix::zeros(3 * count, 3 * count);
    for i in 0..count {
        let entries = matrix.diagonal.each_ref().map(|entries| f64::from(entries[i]));
        for ((row, column), entry) in
            [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)].into_iter().zip(entries)
        {
            dense[(3 * i + row, 3 * i + column)] = entry;
            dense[(3 * i + column, 3 * i + row)] = entry;
        }
    }
    for (&[a, b], block) in pairs.iter().zip(&matrix.pairs) {
        let [a, b] = [a.min(b), a.max(b)].map(|end| 3 * end as usize);
        for (i, &entry) in block.iter().enumerate() {
            dense[(a + i / 3, b + i % 3)] = -f64::from(entry);
            dense[(b + i % 3, a + i / 3)] = -f64::from(entry);
        }
    }
    dense
}

fn worst_error(positions: &[Vector], pairs: &[[u32; 2]], (matrix, least): &Problem) -> f64 {
    let count = positions.len();
    let graph = Graph::new(count, pairs);
    let mut cholesky = Cholesky::new(&graph, positions);
    let r = noise(count);
    let mut z = Field::zeros(count);
    for _ in 0..2 {
        cholesky.factor(matrix, least);
        cholesky.apply_inverse(&r, &mut z);
    }
    let flat = |field: &Field| DVector::from_fn(3 * count, |i, _| f64::from(field.0[i % 3][i / 3]));
    let exact = dense(pairs, matrix).cholesky().expect("positive definite").solve(&flat(&r));
    (flat(&z) - &exact).norm() / exact.norm()
}

#[test]
fn a_solve_agrees_with_dense_elimination_on_grids_of_any_shape() {
    for (columns, rows) in [(1, 1), (2, 1), (5, 5), (40, 1), (17, 23), (100, 3)] {
        let (positions, pairs) = grid(columns, rows);
        let error = worst_error(&positions, &pairs, &problem(&pairs, positions.len(), &[0], 0.1));
        assert!(error < 1e-4, "{columns} x {rows}: {error}");
    }
}

/// Blocks that are not symmetric, as triangles under tension have them.
#[test]
fn a_solve_agrees_where_blocks_are_skew() {
    let (positions, pairs) = grid(12, 9);
    let mut problem = problem(&pairs, positions.len(), &[3], 2.0);
    let free = problem.0.pairs.iter_mut().enumerate().filter(|(_, block)| block[0] > 0.0);
    for (pair, block) in free {
        let tilt = 0.1 * scattered(pair as u64) as f32;
        block[1] += tilt;
        block[3] -= tilt;
    }
    let error = worst_error(&positions, &pairs, &problem);
    assert!(error < 1e-4, "{error}");
}

#[test]
fn a_solve_agrees_where_particles_coincide_or_are_not_joined() {
    let (positions, pairs) = grid(14, 14);
    let one_point = vec![Vector::zeros(); positions.len()];
    let whole = problem(&pairs, positions.len(), &[], 0.1);
    let error = worst_error(&one_point, &pairs, &whole);
    assert!(error < 1e-4, "in one point: {error}");
    let apart: Vec<_> = pairs.iter().copied().filter(|&[a, b]| a / 50 == b / 50).collect();
    let error = worst_error(&positions, &apart, &problem(&apart, positions.len(), &[7], 0.1));
    assert!(error < 1e-4, "in pieces: {error}");
    let error = worst_error(&positions, &[], &problem(&[], positions.len(), &[7], 0.1));
    assert!(error < 1e-6, "none joined: {error}");
}

/// Rounding takes pivots below what they can be; the inverse must stay that of a positive definite matrix.
#[test]
fn hardly_any_inertia_leaves_the_inverse_positive() {
    let (positions, pairs) = grid(40, 40);
    let count = positions.len();
    let graph = Graph::new(count, &pairs);
    let mut cholesky = Cholesky::new(&graph, &positions);
    let (matrix, least) = problem(&pairs, count, &[], 1e-8);
    cholesky.factor(&matrix, &least);
    let mut z = Field::zeros(count);
    for seed in 0..20 {
        let mut r = noise(count);
        r.0.iter_mut().flatten().enumerate().for_each(|(i, r)| {
            *r = if seed == 0 { 1.0 } else { scattered(seed * 10_000 + i as u64) as f32 };
        });
        cholesky.apply_inverse(&r, &mut z);
        let product: f64 = (0..3)
            .flat_map(|axis| r.0[axis].iter().zip(&z.0[axis]))
            .map(|(r, z)| f64::from(*r) * f64::from(*z))
            .sum();
        assert!(product > 0.0 && product.is_finite(), "{seed}: {product}");
    }
}

#[test]
fn pinned_particles_stay_exactly_where_they_are_and_threads_change_no_bit() {
    let (positions, pairs) = grid(70, 40);
    let count = positions.len();
    let pins: Vec<usize> = (0..70).chain([777, 1999]).collect();
    let (matrix, least) = problem(&pairs, count, &pins, 1e-2);
    let graph = Graph::new(count, &pairs);
    let r = noise(count);
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut z = Field::zeros(count);
        pool.expect("threads").install(|| {
            let mut cholesky = Cholesky::new(&graph, &positions);
            cholesky.factor(&matrix, &least);
            cholesky.apply_inverse(&r, &mut z);
        });
        z
    });
    for axis in 0..3 {
        let bits = |z: &Field| z.0[axis].iter().map(|z| z.to_bits()).collect::<Vec<_>>();
        assert!(bits(&one) == bits(&three));
        for &pin in &pins {
            assert_eq!(one.0[axis][pin].to_bits(), r.0[axis][pin].to_bits());
        }
    }
}

/// What is no number must not be lost on the way: the solve that it comes from gives up.
#[test]
fn what_is_no_number_comes_out_as_none() {
    let (positions, pairs) = grid(9, 9);
    let count = positions.len();
    let graph = Graph::new(count, &pairs);
    let (good, least) = problem(&pairs, count, &[], 1.0);
    for bad in [f32::NAN, f32::INFINITY] {
        for (in_pair, in_vector) in [(true, false), (false, true)] {
            let (mut matrix, mut r) = (good.clone(), noise(count));
            if in_pair {
                matrix.pairs[40][4] = bad;
            }
            if in_vector {
                r.0[1][17] = bad;
            }
            let mut cholesky = Cholesky::new(&graph, &positions);
            cholesky.factor(&matrix, &least);
            let mut z = Field::zeros(count);
            cholesky.apply_inverse(&r, &mut z);
            assert!(z.0.iter().flatten().any(|z| !z.is_finite()), "{bad} {in_pair}");
        }
    }
}
