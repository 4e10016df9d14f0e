//! Chebyshev iteration: steps towards the solution of `A x = r` that need no inner products,
//!
//! ```text
//! step = keep step + gain B (r - A x)        x += step
//! ```
//!
//! for a matrix B of which `B A` has its eigenvalues in a known interval.
//!
//! Source: Saad 2003, algorithm 12.1.

/// `keep` and `gain` of each step, for eigenvalues between `low` and `high`.
pub(crate) fn steps(low: f32, high: f32) -> impl Iterator<Item = [f32; 2]> {
    let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
    let ratio = middle / half;
    let mut last = 1.0 / ratio;
    let rest = std::iter::repeat_with(move || {
        let next = 1.0 / (2.0 * ratio - last);
        let step = [next * last, 2.0 * next / half];
        last = next;
        step
    });
    std::iter::once([0.0, 1.0 / middle]).chain(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left of an error along an eigenvector is `T_n(t(lambda))/T_n(t(0))`, t the map of the interval to [-1, 1].
    #[test]
    fn the_error_falls_as_chebyshev_polynomials_do() {
        let (low, high) = (0.5, 2.0);
        let t = |lambda: f64| (2.5 - 2.0 * lambda) / 1.5;
        let polynomial =
            |n: usize, t: f64| (1..n).fold((1.0, t), |(a, b), _| (b, 2.0 * t * b - a)).1;
        for lambda in [0.1_f32, 0.5, 0.9, 1.7, 2.0] {
            let (mut x, mut step) = (0.0, 0.0);
            for (n, [keep, gain]) in steps(low, high).enumerate().take(4) {
                step = keep * step + gain * (1.0 - lambda * x);
                x += step;
                let expected = polynomial(n + 1, t(f64::from(lambda))) / polynomial(n + 1, t(0.0));
                let left = f64::from(1.0 - lambda * x);
                assert!((left - expected).abs() < 1e-5, "{n} {lambda}: {left} {expected}");
            }
        }
    }
}
