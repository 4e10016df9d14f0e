use nalgebra::{DMatrix, DVector};

use super::*;
use crate::scatter::scattered;

/// Columns times rows of particles, each joined to its eight neighbors.
fn grid(columns: u32, rows: u32) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let at = |c: u32, r: u32| r * columns + c;
    let mut pairs = Vec::new();
    for r in 0..rows {
        for c in 0..columns {
            for (dc, dr) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
                let (c2, r2) = (c as i32 + dc, r + dr);
                if (0..columns as i32).contains(&c2) && r2 < rows {
                    pairs.push([at(c, r), at(c2 as u32, r2)]);
                }
            }
        }
    }
    let positions = (0..columns * rows)
        .map(|i| Vector::new(f64::from(i % columns), 0.0, f64::from(i / columns)))
        .collect();
    (positions, pairs)
}

fn matrix(pairs: &[[u32; 2]], count: usize, pins: &[usize]) -> Laplacian {
    let weights = (0..pairs.len() as u64).map(|i| 1.0 + 0.5 * scattered(i)).collect();
    Laplacian::new(pairs, weights, vec![1e-3; count], |particle| pins.contains(&particle))
}

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
    let r = Field(std::array::from_fn(|axis| {
        (0..count as u64).map(|i| scattered(3 * i + axis as u64) as f32).collect()
    }));
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
        assert!(error < 2e-5, "{columns} x {rows}: {error}");
    }
}

#[test]
fn a_solve_agrees_with_dense_elimination_where_particles_coincide_or_are_not_joined() {
    let (positions, pairs) = grid(20, 20);
    let one_point = vec![Vector::zeros(); positions.len()];
    let error = worst_error(&one_point, &pairs, &[]);
    assert!(error < 2e-5, "in one point: {error}");
    let apart: Vec<_> = pairs.iter().copied().filter(|&[a, b]| a / 100 == b / 100).collect();
    let error = worst_error(&positions, &apart, &[7]);
    assert!(error < 2e-5, "in pieces: {error}");
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
    assert!(error < 2e-5, "{error}");
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
#[test]
#[ignore]
fn timing() {
    for side in std::env::var("SIDES").unwrap_or("64 128 256 512".into()).split(" ").map(|s| s.parse().unwrap()) {
        let (positions, pairs) = grid(side, side);
        let graph = Graph::new(positions.len(), &pairs);
        let matrix = matrix(&pairs, positions.len(), &[]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let t = std::time::Instant::now();
        let mut l = pool.install(|| Ldlt::new(&graph, &positions, &matrix));
        let tn = t.elapsed();
        let t = std::time::Instant::now();
        pool.install(|| l.refactor(&graph, &matrix));
        let tf = t.elapsed();
        let r = Field(std::array::from_fn(|axis| (0..positions.len() as u64).map(|i| scattered(3 * i + axis as u64) as f32).collect()));
        let mut z = Field::zeros(positions.len());
        let mut best = [f64::INFINITY; 2];
        for _ in 0..std::env::var("N").map_or(200, |n| n.parse().unwrap()) {
            for (k, p) in [&one, &pool].into_iter().enumerate() {
                p.install(|| {
                let t = std::time::Instant::now();
                for _ in 0..3 { l.apply_inverse(&r, &mut z); }
                best[k] = best[k].min(t.elapsed().as_secs_f64() / 3.0);
                });
            }
        }
        println!("{side}: new {tn:?} factor {tf:?} size {:.2}M fronts {} runs {} solve {:.3} {:.3} ms", l.size() as f64 * 1e-6, l.symbolic.fronts.len(), l.symbolic.fronts.iter().map(|f| f.runs.len()).sum::<usize>(), best[0] * 1e3, best[1] * 1e3);
    }
}
