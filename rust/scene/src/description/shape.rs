//! `[cloth.shrink]`, `[cloth.pressure]`, `[cloth.sewing]`: what changes a cloth's shape.
//!
//! ```toml
//! [cloth.shrink]
//! min = 0.0                       # everywhere
//! max = 0.2                       # where the weight is 1
//! weights = [0.0, 0.5, 1.0]       # one for each vertex, 0 if missing
//! keyframes = [ { frame = 1, max = 0.0 }, { frame = 24, max = 0.2 } ]
//!
//! [cloth.pressure]
//! uniform = 20.0                  # N/m², whatever the volume
//! factor = 1000.0                 # N/m²: p = uniform + factor (V0/V - 1)
//! target_volume = 0.6             # V0 (m³); that at rest if missing, 0 for none
//!
//! [cloth.sewing]
//! seams = [[0, 8], [1, 9]]        # vertices; the loose edges of the mesh file if missing
//! force_max = 5.0                 # N, 0 for no limit
//! weld_distance = 0.001           # m, 0 for never
//! ```

use boucle_solver::{Pressure, SHRINK, Sewing};
use serde::{Deserialize, Serialize};

use super::table;
use crate::error::{Error, Result};
use crate::limits;

/// Largest pressure (N/m²), volume (m³) and force (N).
const MOST: f64 = 1e12;

/// By which part rest lengths are less.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Shrink {
    /// Fraction at vertices of weight 0; below 0 the cloth grows.
    pub min: f64,
    /// Fraction at vertices of weight 1.
    pub max: f64,
    /// Weight of each vertex, 0 to 1; 0 if missing.
    pub weights: Vec<f64>,
    /// Other fractions at frames, straight lines between them; those above if empty.
    #[serde(deserialize_with = "table::list")]
    pub keyframes: Vec<ShrinkKeyframe>,
}

/// Fractions at one frame; those of the table where missing.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShrinkKeyframe {
    /// The frame.
    pub frame: i32,
    /// Fraction at vertices of weight 0.
    pub min: Option<f64>,
    /// Fraction at vertices of weight 1.
    pub max: Option<f64>,
}

impl Shrink {
    /// Both fractions at a frame.
    #[must_use]
    pub fn at(&self, frame: i32) -> [f64; 2] {
        let whole = [self.min, self.max];
        let of = |key: &ShrinkKeyframe| {
            (key.frame, [key.min.unwrap_or(self.min), key.max.unwrap_or(self.max)])
        };
        between(self.keyframes.iter().map(of), frame).unwrap_or(whole)
    }

    /// The fraction at each of so many vertices.
    #[must_use]
    pub fn of_vertices(&self, [min, max]: [f64; 2], count: usize) -> Vec<f64> {
        let weight = |vertex: usize| self.weights.get(vertex).copied().unwrap_or(0.0);
        (0..count).map(|vertex| min + (max - min) * weight(vertex)).collect()
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        let [least, most] = SHRINK;
        let fraction = |key: String, value| {
            limits::within(&key, value, &(least..=most), &format!("{least} to {most}"))
        };
        fraction(format!("{at}.min"), self.min)?;
        fraction(format!("{at}.max"), self.max)?;
        for (index, key) in self.keyframes.iter().enumerate() {
            let at = format!("{at}.keyframes.{index}");
            fraction(format!("{at}.min"), key.min.unwrap_or(0.0))?;
            fraction(format!("{at}.max"), key.max.unwrap_or(0.0))?;
        }
        check_weights(&format!("{at}.weights"), &self.weights)?;
        check_frames(&format!("{at}.keyframes"), self.keyframes.iter().map(|key| key.frame))
    }
}

/// What a cloth is inflated by.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PressureDescription {
    /// The part of the pressure (N/m²) that does not depend on the volume.
    pub uniform: f64,
    /// How much pressure (N/m²) twice the density of the filling adds.
    pub factor: f64,
    /// The volume (m³) at which the filling balances; that at rest if missing, 0 for none.
    pub target_volume: Option<f64>,
    /// Weight of each vertex, 0 to 1; 1 if missing.
    pub weights: Vec<f64>,
    /// Other numbers at frames, straight lines between them; those above if empty.
    #[serde(deserialize_with = "table::list")]
    pub keyframes: Vec<PressureKeyframe>,
}

/// Numbers at one frame; those of the table where missing.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressureKeyframe {
    /// The frame.
    pub frame: i32,
    /// N/m²
    pub uniform: Option<f64>,
    /// N/m²
    pub factor: Option<f64>,
}

impl PressureDescription {
    /// `uniform` and `factor` at a frame.
    #[must_use]
    pub fn at(&self, frame: i32) -> [f64; 2] {
        let whole = [self.uniform, self.factor];
        let of = |key: &PressureKeyframe| {
            let [uniform, factor] = whole;
            (key.frame, [key.uniform.unwrap_or(uniform), key.factor.unwrap_or(factor)])
        };
        between(self.keyframes.iter().map(of), frame).unwrap_or(whole)
    }

    /// The pressure at a frame as the solver takes it.
    #[must_use]
    pub fn pressure(&self, frame: i32) -> Pressure {
        let [uniform, factor] = self.at(frame);
        let Self { target_volume, ref weights, .. } = *self;
        Pressure { uniform, factor, target_volume, weights: weights.clone() }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        let numbers = |at: &str, uniform, factor| {
            let both = "-1e12 to 1e12 N/m²";
            limits::within(&format!("{at}.uniform"), uniform, &(-MOST..=MOST), both)?;
            limits::within(&format!("{at}.factor"), factor, &(0.0..=MOST), "0 to 1e12 N/m²")
        };
        numbers(at, self.uniform, self.factor)?;
        for (index, key) in self.keyframes.iter().enumerate() {
            let at = format!("{at}.keyframes.{index}");
            numbers(&at, key.uniform.unwrap_or(0.0), key.factor.unwrap_or(0.0))?;
        }
        let volume = self.target_volume.unwrap_or(0.0);
        limits::within(&format!("{at}.target_volume"), volume, &(0.0..=MOST), "0 to 1e12 m³")?;
        check_weights(&format!("{at}.weights"), &self.weights)?;
        check_frames(&format!("{at}.keyframes"), self.keyframes.iter().map(|key| key.frame))
    }
}

/// Loose edges that draw their ends together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SewingDescription {
    /// Both vertices of each; the loose edges of the mesh if missing.
    pub seams: Option<Vec<[u32; 2]>>,
    /// Largest force (N) of one seam; 0 for no limit.
    pub force_max: f64,
    /// Ends that come nearer than this (m) stay joined for good; 0 for never.
    pub weld_distance: f64,
}

impl SewingDescription {
    /// The seams as the solver takes them, given the loose edges of the mesh.
    #[must_use]
    pub fn sewing(&self, loose_edges: &[[u32; 2]]) -> Sewing {
        let Self { seams, force_max, weld_distance } = self;
        let seams = seams.clone().unwrap_or_else(|| loose_edges.to_vec());
        Sewing { seams, force_max: *force_max, weld_distance: *weld_distance }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        let Self { force_max, weld_distance, .. } = self;
        limits::within(&format!("{at}.force_max"), *force_max, &(0.0..=MOST), "0 to 1e12 N")?;
        let longest = limits::MAX_LENGTH;
        let key = format!("{at}.weld_distance");
        limits::within(&key, *weld_distance, &(0.0..=longest), &format!("0 to {longest:e} m"))
    }
}

/// What two numbers are at a frame, if there are keyframes.
fn between(
    keys: impl DoubleEndedIterator<Item = (i32, [f64; 2])> + Clone,
    frame: i32,
) -> Option<[f64; 2]> {
    let before = keys.clone().rev().find(|(at, _)| *at <= frame);
    let mut keys = keys;
    let after = keys.find(|(at, _)| *at > frame);
    Some(match (before, after) {
        (Some((from, one)), Some((to, other))) => {
            let share = f64::from(frame - from) / f64::from(to - from);
            std::array::from_fn(|i| one[i] + share * (other[i] - one[i]))
        }
        (Some((_, only)), None) | (None, Some((_, only))) => only,
        (None, None) => return None,
    })
}

fn check_weights(at: &str, weights: &[f64]) -> Result<()> {
    match weights.iter().position(|weight| !(0.0..=1.0).contains(weight)) {
        Some(vertex) => Err(Error::refuse(&format!("{at}.{vertex}"), weights[vertex], "0 to 1")),
        None => Ok(()),
    }
}

fn check_frames(at: &str, frames: impl Iterator<Item = i32>) -> Result<()> {
    let mut last = None;
    for (index, frame) in frames.enumerate() {
        let key = format!("{at}.{index}.frame");
        limits::frame(&key, frame)?;
        if let Some(last) = last.filter(|&last| frame <= last) {
            return Err(Error::refuse(&key, frame, &format!("a frame after {last}")));
        }
        last = Some(frame);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_keyframes_numbers_go_straight_and_rest_before_and_after_them() {
        let key = |frame, uniform| PressureKeyframe { frame, uniform, factor: None };
        let keyframes = vec![key(10, Some(0.0)), key(20, Some(50.0)), key(30, None)];
        let pressure =
            PressureDescription { uniform: 7.0, factor: 3.0, keyframes, ..Default::default() };
        let uniform = |frame| pressure.at(frame)[0];
        for (frame, expected) in [(1, 0.0), (10, 0.0), (15, 25.0), (20, 50.0), (30, 7.0), (99, 7.0)]
        {
            assert!((uniform(frame) - expected).abs() < 1e-12, "frame {frame}");
        }
        assert!((pressure.at(15)[1] - 3.0).abs() < 1e-12);
        assert!(
            (PressureDescription { uniform: 7.0, ..Default::default() }.at(5)[0] - 7.0).abs()
                < 1e-12
        );
    }

    #[test]
    fn shrink_goes_from_min_to_max_by_weight() {
        let shrink = Shrink { weights: vec![0.0, 0.5, 1.0], ..Shrink::default() };
        assert_eq!(shrink.of_vertices([0.25, 0.75], 4), [0.25, 0.5, 0.75, 0.25]);
    }
}
