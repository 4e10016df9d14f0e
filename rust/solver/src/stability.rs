//! The largest stable step of the actual springs.
//!
//! Around any shape, springs of stiffness k and damping kd move as oscillators `x'' = -w² x - c x'` whose w² and c
//! are bounded by the graph Laplacians they weigh:
//!
//! ```text
//! w² <= largest eigenvalue of M⁻¹ sum k  L_e   <= 2 max_i sum_j k_ij/m_i      (1/s²)
//! c  <= largest eigenvalue of M⁻¹ sum kd L_e + (ka + kw)/m                    (1/s)
//! c  >= w² min kd/k + min ka/m          relative damping only: the axial law leaves turning springs undamped
//! goal springs add k/m to w² and c/m to c at their particles, at the most the largest of them
//! ```
//!
//! The eigenvalues come from a power iteration with a margin, and never exceed the closed bound. A step is stable if
//! the integrator's amplification matrix has a spectral radius of at most 1 for every such oscillator, or grows by
//! less than 1 % a second: then forward Euler and the midpoint rule have a step too, if a tiny one.
//!
//! Source: the closed bound is Gershgorin's theorem; the matrices stand beside the integrators.

use nalgebra::{Complex, Matrix2};

use crate::cloth::{Cloth, placed};
use crate::integrator::Integrator;
use crate::material::{DampingLaw, Limiter};
use crate::scatter::scattered;
use crate::system::System;

/// Growth of an amplitude (1/s) that still counts as stable.
const GROWTH: f64 = 0.01;

/// What the power iteration may fall short by, as a factor.
const MARGIN: f64 = 1.05;

/// How much stiffer triangles may be where they are strained: by 15 %, the tangent of Green's strain has grown so.
const STRAINED: f64 = 1.5;

/// Rounds of the power iteration: after 60 it is within 3 % on every mesh tried.
const ROUNDS: usize = 60;

/// The oscillators that a system may move as.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spectrum {
    /// Largest w² (1/s²).
    pub(crate) w_squared: f64,
    /// Largest c (1/s), but for the pressure of wind, which depends on the state.
    pub(crate) damping: f64,
    /// Smallest c for each unit of w² (s).
    pub(crate) damping_by_stiffness: f64,
    /// Smallest c that does not depend on w (1/s).
    pub(crate) air_damping: f64,
}

impl Spectrum {
    pub(crate) fn of(cloths: &[Cloth], system: &System) -> Self {
        let mut stiffness = weighted_edges(cloths, |cloth| {
            cloth.springs.iter().map(|spring| spring.stiffness).collect()
        });
        let mut damping = weighted_edges(cloths, |cloth| {
            cloth.springs.iter().map(|spring| spring.damping).collect()
        });
        for (pair, [of_stiffness, of_damping]) in system.fabrics.weights() {
            stiffness.push((pair, STRAINED * of_stiffness));
            damping.push((pair, STRAINED * of_damping));
        }
        let [bend, bend_damping] = system.fabrics.bending_bounds(&system.inverse_masses);
        let viscous = (0..system.particle_count())
            .filter(|&particle| !system.is_pinned(particle))
            .map(|particle| system.air_damping[particle] * system.inverse_masses[particle]);
        let wind =
            system.air.damping() * system.inverse_masses.iter().fold(0.0, |a, &b| f64::max(a, b));
        let ratios = cloths.iter().flat_map(|cloth| {
            let is_relative = cloth.material.damping_law == DampingLaw::Relative;
            cloth.springs.iter().filter(|spring| spring.stiffness > 0.0).map(move |spring| {
                if is_relative { spring.damping / spring.stiffness } else { 0.0 }
            })
        });
        // Hinges and triangles may be damped less than all springs.
        let ratios = ratios.chain((!system.fabrics.is_empty()).then_some(0.0));
        let ratio = ratios.fold(f64::INFINITY, f64::min);
        let least_air = viscous.clone().fold(f64::INFINITY, f64::min);
        let largest = |edges: &[WeightedEdge]| largest_eigenvalue(edges, &system.inverse_masses);
        let (w_squared, damping) = rayon::join(|| largest(&stiffness), || largest(&damping));
        Self {
            w_squared: w_squared + bend,
            damping: damping + bend_damping + viscous.fold(0.0, f64::max) + wind,
            damping_by_stiffness: if ratio.is_finite() { ratio } else { 0.0 },
            air_damping: if least_air.is_finite() { least_air } else { 0.0 },
        }
    }

    /// The same with stiffer springs, by a factor of at least 1.
    pub(crate) fn stiffened(self, factor: f64) -> Self {
        Self {
            w_squared: self.w_squared * factor,
            damping_by_stiffness: self.damping_by_stiffness / factor,
            ..self
        }
    }

    /// The same with so much more damping (1/s) and stiffness by mass (1/s²).
    pub(crate) fn with(self, damping: f64, w_squared: f64) -> Self {
        Self { damping: self.damping + damping, w_squared: self.w_squared + w_squared, ..self }
    }

    /// The same with goal springs, given their largest k/m (1/s²) and c/m (1/s) and smallest c/k (s).
    pub(crate) fn with_goals(self, [stiffness, damping, ratio]: [f64; 3]) -> Self {
        if stiffness == 0.0 {
            return self;
        }
        Self {
            w_squared: self.w_squared + stiffness,
            damping: self.damping + damping,
            damping_by_stiffness: self.damping_by_stiffness.min(ratio),
            ..self
        }
    }

    /// The largest stable step (s) up to `longest`.
    pub(crate) fn largest_step(&self, integrator: &dyn Integrator, longest: f64) -> f64 {
        let is_stable = |h: f64| self.is_stable(integrator, h);
        if is_stable(longest) {
            return longest;
        }
        let mut stable = longest;
        while !is_stable(stable) {
            stable *= 0.5;
            if stable < 1e-15 {
                return 0.0;
            }
        }
        let mut unstable = 2.0 * stable;
        for _ in 0..40 {
            let middle = 0.5 * (stable + unstable);
            *if is_stable(middle) { &mut stable } else { &mut unstable } = middle;
        }
        stable
    }

    fn is_stable(&self, integrator: &dyn Integrator, h: f64) -> bool {
        const STIFFNESSES: i32 = 40;
        const DAMPINGS: u32 = 8;
        (0..=STIFFNESSES).all(|i| {
            // From the stiffest oscillator down to one of a millionth of its stiffness.
            let w_squared =
                self.w_squared * 10f64.powf(-6.0 * f64::from(i) / f64::from(STIFFNESSES));
            let least = self.air_damping + self.damping_by_stiffness * w_squared;
            (0..=DAMPINGS).all(|j| {
                let part = f64::from(j) / f64::from(DAMPINGS);
                let c = least + part * (self.damping - least).max(0.0);
                spectral_radius(&integrator.amplification(w_squared, c, h))
                    <= 1.0 + GROWTH * h + 1e-12
            })
        })
    }
}

/// How much stiffer equation 6 makes the springs of a strained cloth: the slope of its force, `2 L/L0 - 1`,
/// with room for as much again before the next frame.
pub(crate) fn stiffening(cloths: &[Cloth], longest_ratio: impl Fn(usize) -> f64) -> f64 {
    let slopes = cloths.iter().enumerate().map(|(i, cloth)| match cloth.material.limiter {
        Limiter::Stiffen => {
            let ratio = longest_ratio(i).max(1.0 + cloth.material.deformation_rate);
            1.0 + 2.0 * (2.0 * ratio - 2.0)
        }
        _ => 1.0,
    });
    slopes.fold(1.0, f64::max)
}

/// Largest absolute eigenvalue.
pub(crate) fn spectral_radius(matrix: &Matrix2<f64>) -> f64 {
    let half_trace = 0.5 * matrix.trace();
    let root = Complex::new(half_trace * half_trace - matrix.determinant(), 0.0).sqrt();
    (half_trace + root).norm().max((half_trace - root).norm())
}

type WeightedEdge = ([u32; 2], f64);

fn weighted_edges(cloths: &[Cloth], weights: impl Fn(&Cloth) -> Vec<f64>) -> Vec<WeightedEdge> {
    let mut edges = Vec::new();
    for (cloth, base) in placed(cloths) {
        let pairs = cloth.springs.iter().zip(weights(cloth));
        edges.extend(
            pairs
                .filter(|&(_, weight)| weight > 0.0)
                .map(|(spring, weight)| (spring.ends.map(|end| end + base), weight)),
        );
    }
    edges
}

/// Largest eigenvalue of `M⁻¹ sum w_e L_e`, from above.
fn largest_eigenvalue(edges: &[WeightedEdge], inverse_masses: &[f64]) -> f64 {
    let mut diagonal = vec![0.0; inverse_masses.len()];
    for &([a, b], weight) in edges {
        diagonal[a as usize] += weight;
        diagonal[b as usize] += weight;
    }
    let rows = diagonal.iter().zip(inverse_masses);
    let closed = rows.map(|(sum, w)| 2.0 * sum * w).fold(0.0, f64::max);
    closed.min(MARGIN * power_iteration(edges, &diagonal, inverse_masses))
}

fn power_iteration(edges: &[WeightedEdge], diagonal: &[f64], inverse_masses: &[f64]) -> f64 {
    // Symmetric form W L W with W = M^-1/2, from a start that favours no direction.
    let roots: Vec<f64> = inverse_masses.iter().map(|w| w.sqrt()).collect();
    let mut vector: Vec<f64> = (0..roots.len() as u64).map(scattered).collect();
    let mut eigenvalue = 0.0;
    let [mut scaled, mut product] = [vec![0.0; roots.len()], vec![0.0; roots.len()]];
    for _ in 0..ROUNDS {
        for (i, (scaled, product)) in scaled.iter_mut().zip(&mut product).enumerate() {
            *scaled = vector[i] * roots[i];
            *product = *scaled * diagonal[i];
        }
        for &([a, b], weight) in edges {
            product[a as usize] -= weight * scaled[b as usize];
            product[b as usize] -= weight * scaled[a as usize];
        }
        for (x, root) in product.iter_mut().zip(&roots) {
            *x *= root;
        }
        let norm = product.iter().map(|x| x * x).sum::<f64>().sqrt();
        if norm == 0.0 {
            return 0.0;
        }
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        eigenvalue = f64::max(eigenvalue, norm / length);
        for (x, product) in vector.iter_mut().zip(&product) {
            *x = product / norm;
        }
    }
    eigenvalue
}
