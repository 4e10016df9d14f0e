//! Water: its surface, its current, and how it pushes faces.
//!
//! The surface lies at a height, calm or in waves that run over it. With k = 2 pi/length, the angle `a = k (d·x) - w t` and z the depth
//! under the calm surface, less than 0, a wave of height A runs in the direction d with
//!
//! ```text
//! surface  = level + A cos a                          (m)
//! velocity = current + A w e^(k z) (cos a d + sin a e_z)   (m/s)          w² = g k
//! ```
//!
//! Waves of several lengths add up. They ride on the current: x is counted from where it has carried them. g is standard gravity,
//! whatever the scene's is.
//!
//! Cloth takes up water by a wetness from 0 to 1, which changes between frames: t seconds under water, or out of it, make of w
//!
//! ```text
//! sqrt(min(1, w² + t/soak_time))          max(0, w - t/dry_time)
//! ```
//!
//! and the mass of what is dry `1 + absorbency w` times as much.
//!
//! Sources: Airy 1845, small waves on deep water; Washburn 1921 for the square root of time.

use std::f64::consts::TAU;

use boucle_geometry::Vector;

use super::flow::Flow;
use crate::cloth::FARTHEST;
use crate::error::{Error, Result};

/// Standard gravity (m/s²), by which waves run.
const GRAVITY: f64 = 9.806_65;

/// One train of waves.
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Half of the height (m) from trough to crest.
    pub amplitude: f64,
    /// From crest to crest (m).
    pub length: f64,
    /// Where it runs; its length and its part along z do not count.
    pub direction: Vector,
}

impl Wave {
    /// k (1/m), and w (1/s).
    fn numbers(&self) -> [f64; 2] {
        let k = TAU / self.length;
        [k, (GRAVITY * k).sqrt()]
    }

    fn way(&self) -> Vector {
        Vector::new(self.direction.x, self.direction.y, 0.0).normalize()
    }
}

/// A body of water that has no bottom and no shore.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// Height (m) of the calm surface.
    pub level: f64,
    /// Velocity (m/s) of the current.
    pub velocity: Vector,
    /// What it is and how it pushes faces.
    pub flow: Flow,
    /// Waves on it.
    pub waves: Vec<Wave>,
}

impl Default for Water {
    /// Calm, up to z = 0, 1000 kg/m³.
    fn default() -> Self {
        let flow = Flow { friction: 0.01, ..Flow::new(1000.0) };
        Self { level: 0.0, velocity: Vector::zeros(), flow, waves: Vec::new() }
    }
}

impl Water {
    /// Refuses values outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first thing that is not accepted.
    pub fn check(&self) -> Result<()> {
        let within = |quantity: &str, value: f64, [least, most]: [f64; 2], domain| {
            if (least..=most).contains(&value) {
                return Ok(());
            }
            Err(Error::OutOfDomain { quantity: format!("water: {quantity}"), value, domain })
        };
        self.flow.check("water")?;
        within("level (m)", self.level, [-FARTHEST, FARTHEST], "-1e6 to 1e6")?;
        for &speed in &self.velocity {
            within("velocity (m/s)", speed, [-1e3, 1e3], "-1000 to 1000")?;
        }
        for wave in &self.waves {
            within("amplitude of a wave (m)", wave.amplitude, [0.0, 1e3], "0 to 1000")?;
            within("length of a wave (m)", wave.length, [1e-3, FARTHEST], "1e-3 to 1e6")?;
            let along = wave.direction.xy().norm();
            let domain = "some length along x or y";
            within("direction of a wave, of which the level part", along, [1e-9, 1e9], domain)?;
        }
        Ok(())
    }

    /// No water is faster (m/s) below the crests.
    pub(super) fn most_speed(&self) -> f64 {
        let orbits = self.waves.iter().map(|wave| {
            let [k, w] = wave.numbers();
            wave.amplitude * w * (k * wave.amplitude).exp()
        });
        self.velocity.norm() + orbits.sum::<f64>()
    }

    /// How deep (m) a place (m) lies under the surface after so many seconds in which the current has come so far (m); below 0
    /// above it.
    pub(super) fn depth(&self, place: &Vector, time: f64, drift: &Vector) -> f64 {
        let heights = self.waves.iter().map(|wave| {
            let [k, w] = wave.numbers();
            wave.amplitude * (k * wave.way().dot(&(place - drift)) - w * time).cos()
        });
        self.level + heights.sum::<f64>() - place.z
    }

    /// The velocity (m/s) of the water at a place (m), as above.
    pub(super) fn velocity_at(&self, place: &Vector, time: f64, drift: &Vector) -> Vector {
        let orbits = self.waves.iter().map(|wave| {
            let ([k, w], way) = (wave.numbers(), wave.way());
            let (sin, cos) = (k * way.dot(&(place - drift)) - w * time).sin_cos();
            let decay = (k * (place.z - self.level).min(wave.amplitude)).exp();
            wave.amplitude * w * decay * (cos * way + sin * Vector::z())
        });
        self.velocity + orbits.sum::<Vector>()
    }
}

/// How a cloth meets water.
#[derive(Clone, Debug, PartialEq)]
pub struct Bulk {
    /// What it weighs by its volume, pores included, while it is dry (kg/m³): areal density over thickness.
    pub density: f64,
    /// Whether water stays outside it; that of a closed mesh does if `None`.
    pub is_hull: Option<bool>,
    /// Mass of the water that it takes up at the most, in parts of its own.
    pub absorbency: f64,
    /// Seconds in which dry cloth under water takes up all that.
    pub soak_time: f64,
    /// Seconds in which it gives all that off again out of the water; never if `None`.
    pub dry_time: Option<f64>,
}

impl Default for Bulk {
    /// 500 kg/m³, between a knit and a tight weave; it takes up nothing.
    fn default() -> Self {
        let density = 500.0;
        Self { density, is_hull: None, absorbency: 0.0, soak_time: 10.0, dry_time: None }
    }
}

impl Bulk {
    /// Refuses values outside their domains, for a cloth of a name.
    pub(crate) fn check(&self, cloth: &str) -> Result<()> {
        for (what, value, [least, most], domain) in [
            ("bulk_density (kg/m³)", self.density, [1.0, 1e5], "1 to 1e5"),
            ("absorbency", self.absorbency, [0.0, 100.0], "0 to 100"),
            ("soak_time (s)", self.soak_time, [1e-3, 1e9], "1e-3 to 1e9"),
            ("dry_time (s)", self.dry_time.unwrap_or(1.0), [1e-3, 1e9], "1e-3 to 1e9"),
        ] {
            if !(least..=most).contains(&value) {
                let quantity = format!("cloth \"{cloth}\": {what} in water");
                return Err(Error::OutOfDomain { quantity, value, domain });
            }
        }
        Ok(())
    }

    /// How wet it is after so many seconds (s) more, under water or not: 0 dry to 1 full.
    ///
    /// Capillaries fill as the square root of time (Lucas 1918, Washburn 1921), and cloth dries evenly.
    pub(super) fn soak(&self, wetness: f64, seconds: f64, is_under: bool) -> f64 {
        match self.dry_time {
            _ if is_under => (wetness * wetness + seconds / self.soak_time).min(1.0).sqrt(),
            Some(time) => (wetness - seconds / time).max(0.0),
            None => wetness,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rough() -> Water {
        let wave = |amplitude, length, [x, y]: [f64; 2]| Wave {
            amplitude,
            length,
            direction: Vector::new(x, y, 0.5),
        };
        let waves = vec![wave(0.1, 4.0, [2.0, 0.0]), wave(0.03, 1.5, [1.0, -1.0])];
        Water { level: 0.7, velocity: Vector::new(0.3, 0.1, 0.0), waves, ..Water::default() }
    }

    /// Deep water: 4 m from crest to crest pass in 1.601 s, 2.499 m/s.
    #[test]
    fn a_wave_runs_with_the_speed_of_deep_water() {
        let wave = Wave { amplitude: 0.1, length: 4.0, direction: Vector::x() };
        let water = Water { waves: vec![wave], ..Water::default() };
        let speed = (GRAVITY * 4.0 / TAU).sqrt();
        assert!((speed - 2.499).abs() < 1e-3);
        let still = Vector::zeros();
        for t in [0.0, 0.4, 7.3] {
            let crest = water.depth(&Vector::new(speed * t, 3.0, 0.0), t, &still);
            assert!((crest - 0.1).abs() < 1e-9, "{crest}");
        }
    }

    /// What lies in the surface rises with it, and no volume is lost: by central differences, to the first order in steepness.
    #[test]
    fn the_velocity_of_waves_is_that_of_their_surface_and_has_no_divergence() {
        const STEP: f64 = 1e-5;
        let (water, drift) = (rough(), Vector::new(0.2, -0.4, 0.0));
        for (x, t) in [(0.0, 0.0), (0.9, 0.3), (-2.3, 5.7)] {
            let place = Vector::new(x, 0.4 * x, water.level);
            let carried = |dt: f64| drift + dt * water.velocity;
            let [a, b] = [STEP, -STEP]
                .map(|dt| water.depth(&(place + dt * water.velocity), t + dt, &carried(dt)));
            let rise = water.velocity_at(&place, t, &drift).z;
            assert!(((a - b) / (2.0 * STEP) - rise).abs() < 1e-6, "{rise}");
            let below = place - Vector::z() * 0.3;
            let part = |axis: usize| {
                let way = Vector::ith(axis, STEP);
                let [a, b] =
                    [below + way, below - way].map(|at| water.velocity_at(&at, t, &drift)[axis]);
                (a - b) / (2.0 * STEP)
            };
            assert!((part(0) + part(1) + part(2)).abs() < 1e-6);
            assert!(water.velocity_at(&below, t, &drift).norm() <= water.most_speed());
        }
    }

    #[test]
    fn cloth_soaks_by_the_square_root_of_time_and_dries_evenly() {
        let bulk = Bulk { soak_time: 4.0, dry_time: Some(20.0), ..Bulk::default() };
        let mut wetness = 0.0;
        for frame in 1..=30 {
            wetness = bulk.soak(wetness, 0.1, true);
            assert!((wetness - (0.1 * f64::from(frame) / 4.0).sqrt()).abs() < 1e-12);
        }
        assert_eq!(bulk.soak(wetness, 2.0, true).to_bits(), 1.0_f64.to_bits());
        assert!((bulk.soak(1.0, 5.0, false) - 0.75).abs() < 1e-12);
        assert_eq!(bulk.soak(0.1, 5.0, false).to_bits(), 0.0_f64.to_bits());
        let kept = Bulk { dry_time: None, ..bulk };
        assert_eq!(kept.soak(0.1, 5.0, false).to_bits(), 0.1_f64.to_bits());
    }

    #[test]
    fn what_no_water_is_is_refused() {
        let wave = || Wave { amplitude: 0.1, length: 1.0, direction: Vector::x() };
        for (water, said) in [
            (Water { level: f64::NAN, ..Water::default() }, "water: level (m) is NaN"),
            (
                Water { velocity: Vector::x() * 2e3, ..Water::default() },
                "water: velocity (m/s) is 2000",
            ),
            (
                Water { waves: vec![Wave { length: 0.0, ..wave() }], ..Water::default() },
                "water: length of a wave (m) is 0",
            ),
            (
                Water {
                    waves: vec![Wave { direction: Vector::z(), ..wave() }],
                    ..Water::default()
                },
                "water: direction of a wave",
            ),
        ] {
            let refused = water.check().expect_err("out of its domain").to_string();
            assert!(refused.starts_with(said), "{refused}");
        }
        assert_eq!(rough().check(), Ok(()));
    }
}
