//! How a wind changes with time and place: gusts and turbulence.
//!
//! Gusts come one after the other, each a period T (s) long, and add to the wind's mean velocity U (m/s) along it. Within one, after
//! t seconds, the velocity is
//!
//! ```text
//! U ( 1 + s_i (1 - cos(2 pi t/T))/2 )        s_i: at random between 0 and the strength
//! ```
//!
//! Turbulence is smooth noise in space with eddies of a size (m), which the mean wind carries along unchanged: what passes a place
//! is what lies upwind of it. Its strength is the intensity I, the spread of each component of the velocity over |U|.
//!
//! Sources: CS-25.341 of the aviation authorities (the gust of "1 - cosine"); Taylor 1938 (turbulence is carried along frozen);
//! Perlin 2002 (the noise).

use std::f64::consts::TAU;

use boucle_geometry::Vector;

use super::field::turbulence;
use crate::error::{Error, Result};
use crate::scatter::{mixed, scattered};

/// The spread of a component of the noise: see its test.
const SPREAD: f64 = 0.177;

/// Gusts of a wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gusts {
    /// By how much of its mean velocity the wind grows at the most.
    pub strength: f64,
    /// How long (s) each gust is.
    pub period: f64,
    /// Chooses the random numbers.
    pub seed: u32,
}

impl Gusts {
    pub(super) fn check(&self) -> Result<()> {
        within("strength of gusts", self.strength, [0.0, 100.0], "0 to 100")?;
        within("period of gusts (s)", self.period, [1e-3, 1e6], "1e-3 to 1e6")
    }

    /// What the mean velocity is multiplied by after so many seconds.
    pub(super) fn factor(&self, time: f64) -> f64 {
        let turns = time / self.period;
        let number = turns.floor();
        let place = (u64::from(self.seed) << 32) ^ (number as i64).cast_unsigned();
        let peak = self.strength * (0.5 + 0.5 * scattered(mixed(place)));
        1.0 + peak * 0.5 * (1.0 - (TAU * (turns - number)).cos())
    }
}

/// Turbulence of a wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// Spread of each component of the velocity, in parts of the mean speed.
    pub intensity: f64,
    /// Size (m) of the largest eddies.
    pub size: f64,
    /// Chooses the eddies.
    pub seed: u32,
}

impl Turbulence {
    pub(super) fn check(&self) -> Result<()> {
        within("intensity of turbulence", self.intensity, [0.0, 10.0], "0 to 10")?;
        within("size of turbulence (m)", self.size, [1e-3, 1e6], "1e-3 to 1e6")
    }

    /// What it adds to the velocity (m/s) at a place (m) in the air that the mean wind carries, for a mean speed (m/s).
    pub(super) fn velocity(&self, place: &Vector, speed: f64) -> Vector {
        let seed = u64::from(self.seed) << 2;
        let elsewhere = Vector::from_fn(|axis, _| 1e4 * scattered(seed + axis as u64));
        (self.intensity * speed / SPREAD) * turbulence(&(place / self.size + elsewhere), 1.0)
    }

    /// No component is above this part of the mean speed.
    pub(super) fn most(&self) -> f64 {
        self.intensity / SPREAD
    }
}

fn within(quantity: &str, value: f64, [least, most]: [f64; 2], domain: &'static str) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfDomain { quantity: format!("the {quantity} in a wind"), value, domain })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At its middle a gust is as strong as it was drawn, and its mean over time is half of that.
    #[test]
    fn a_gust_rises_and_falls_as_one_minus_cosine() {
        let gusts = Gusts { strength: 0.8, period: 2.5, seed: 3 };
        let mut peaks = Vec::new();
        for number in 0..400 {
            let begin = 2.5 * f64::from(number);
            let at = |part: f64| gusts.factor(begin + part * 2.5) - 1.0;
            let peak = at(0.5);
            assert!((0.0..=0.8).contains(&peak), "{peak}");
            assert!(at(1e-9).abs() < 1e-9 && (at(0.25) - 0.5 * peak).abs() < 1e-9);
            let samples = 64;
            let mean = (0..samples).map(|i| at(f64::from(i) / f64::from(samples))).sum::<f64>();
            assert!((mean / f64::from(samples) - 0.5 * peak).abs() < 1e-9);
            peaks.push(peak);
        }
        let mean = peaks.iter().sum::<f64>() / 400.0;
        assert!((mean - 0.4).abs() < 0.04, "{mean}");
        let other = Gusts { seed: 4, ..gusts };
        assert!((other.factor(1.25) - gusts.factor(1.25)).abs() > 1e-3);
    }

    #[test]
    fn turbulence_has_the_spread_that_its_intensity_says_and_no_mean() {
        let turbulence = Turbulence { intensity: 0.2, size: 0.7, seed: 9 };
        let (mut mean, mut square) = (Vector::zeros(), 0.0);
        for i in 0..20_000_u64 {
            let place = Vector::from_fn(|axis, _| 40.0 * scattered(3 * i + axis as u64));
            let velocity = turbulence.velocity(&place, 5.0);
            assert!(velocity.amax() <= 5.0 * turbulence.most());
            mean += velocity / 20_000.0;
            square += velocity.norm_squared() / 60_000.0;
        }
        assert!((square.sqrt() / (0.2 * 5.0) - 1.0).abs() < 0.05, "{}", square.sqrt());
        assert!(mean.norm() < 0.05, "{mean:?}");
        let other = Turbulence { seed: 10, ..turbulence };
        let place = Vector::new(0.3, 0.1, 0.2);
        assert!((other.velocity(&place, 5.0) - turbulence.velocity(&place, 5.0)).norm() > 1e-3);
    }
}
