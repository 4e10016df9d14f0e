//! `[tear]`, and `[cloth.tear]` in the place of its keys: when cloth tears.
//!
//! ```toml
//! [tear]
//! enabled = true
//! force = 40.0                    # N: the tension of an edge that breaks
//! strain = 0.5                    # or its strain
//! stress = 5000.0                 # N/m: or its tension over the width that it stands for, at any resolution; by default what is known
//!                                 # of a named fabric, if neither of the three is given
//! noise = 0.1                     # thresholds differ by up to this part from edge to edge
//! seed = 0
//! seam_force = 5.0                # N: seams come undone beyond
//!
//! [cloth.tear]
//! start = 10                      # nothing tears before the end of this frame
//! strength = [1.0, 0.5, 1.0]      # the part of force and strain that holds at each vertex; 1 if missing
//! openings = [ { frame = 30, pairs = [[4, 5], [5, 6]] } ]      # edges and seams that open by themselves
//! ```

use boucle_solver::{Opening, Tear};
use serde::{Deserialize, Serialize};

use super::table;
use crate::error::{Error, Result};
use crate::limits;
use crate::preset::FabricPreset;

/// Largest force (N) and strain.
const MOST: f64 = 1e12;

/// `[tear]`: when any cloth tears.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TearDescription {
    /// Whether it does.
    pub enabled: Option<bool>,
    /// Tension (N) of an edge beyond which it breaks.
    pub force: Option<f64>,
    /// Strain beyond which it breaks; if that is not below the deformation rate, the limiter does not act.
    pub strain: Option<f64>,
    /// Stress (N/m) beyond which it breaks.
    pub stress: Option<f64>,
    /// By which part thresholds differ from edge to edge, up and down; 0 if missing.
    pub noise: Option<f64>,
    /// Chooses the random numbers.
    pub seed: Option<u32>,
    /// Force (N) beyond which seams come undone.
    pub seam_force: Option<f64>,
}

/// `[cloth.tear]`: when this cloth tears.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClothTear {
    /// Whether it does.
    pub enabled: Option<bool>,
    /// Tension (N) of an edge beyond which it breaks.
    pub force: Option<f64>,
    /// Strain beyond which it breaks; if that is not below the deformation rate, the limiter does not act.
    pub strain: Option<f64>,
    /// Stress (N/m) beyond which it breaks.
    pub stress: Option<f64>,
    /// By which part thresholds differ from edge to edge, up and down.
    pub noise: Option<f64>,
    /// Chooses the random numbers.
    pub seed: Option<u32>,
    /// Force (N) beyond which seams come undone.
    pub seam_force: Option<f64>,
    /// The part of the thresholds that holds at each vertex, 0 to 1; 1 if missing.
    pub strength: Vec<f64>,
    /// What opens by itself.
    #[serde(deserialize_with = "table::list")]
    pub openings: Vec<OpeningDescription>,
    /// The first frame at whose end anything tears; any if missing.
    pub start: Option<i32>,
}

/// Edges and seams that open at the end of a frame.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpeningDescription {
    /// The frame.
    pub frame: i32,
    /// Pairs of vertices that an edge of a face or a seam joins.
    pub pairs: Vec<[u32; 2]>,
}

impl TearDescription {
    pub(super) fn check(&self, at: &str) -> Result<()> {
        check(at, [self.force, self.strain, self.stress, self.seam_force], self.noise)
    }
}

impl ClothTear {
    pub(super) fn check(&self, at: &str) -> Result<()> {
        check(at, [self.force, self.strain, self.stress, self.seam_force], self.noise)
    }

    /// As the solver takes it, for a cloth of so many vertices, and of a fabric if it is of a named one; nothing if it is not to
    /// tear.
    ///
    /// # Errors
    /// [`Error::Input`] when it is to tear and nothing says when, there are more strengths than vertices, or something is to open
    /// before anything moves.
    pub fn tear(
        &self,
        scene: &TearDescription,
        fabric: Option<&FabricPreset>,
        first_frame: i32,
        vertices: usize,
        at: &str,
    ) -> Result<Option<Tear>> {
        if !self.enabled.or(scene.enabled).unwrap_or(false) {
            return Ok(None);
        }
        if self.strength.len() > vertices {
            let accepted = format!("at most {vertices}, one a vertex");
            return Err(Error::refuse(&format!("{at}.strength"), self.strength.len(), &accepted));
        }
        let mut strength = self.strength.clone();
        if !strength.is_empty() {
            strength.resize(vertices, 1.0);
        }
        for (index, opening) in self.openings.iter().enumerate() {
            if opening.frame <= first_frame {
                let key = format!("{at}.openings.{index}.frame");
                let accepted = format!("after the scene's first frame, {first_frame}");
                return Err(Error::refuse(&key, opening.frame, &accepted));
            }
        }
        let opening =
            |own: &OpeningDescription| Opening { frame: own.frame, pairs: own.pairs.clone() };
        let (force, strain) = (self.force.or(scene.force), self.strain.or(scene.strain));
        let of_fabric = fabric.map(|fabric| fabric.tear_stress);
        let tear = Tear {
            force,
            strain,
            stress: self
                .stress
                .or(scene.stress)
                .or(of_fabric.filter(|_| force.or(strain).is_none())),
            noise: self.noise.or(scene.noise).unwrap_or(0.0),
            seed: self.seed.or(scene.seed).unwrap_or(0),
            strength,
            seam_force: self.seam_force.or(scene.seam_force),
            openings: self.openings.iter().map(opening).collect(),
            start: self.start,
        };
        let says_when =
            [tear.force, tear.strain, tear.stress, tear.seam_force].iter().any(Option::is_some);
        if !says_when && tear.openings.is_empty() {
            return Err(Error::input(format!(
                "{at}.enabled = true, but nothing says when it tears; accepted: with force (N), strain, \
                 stress (N/m), seam_force (N) or openings"
            )));
        }
        Ok(Some(tear))
    }
}

fn check(at: &str, numbers: [Option<f64>; 4], noise: Option<f64>) -> Result<()> {
    for (key, value) in ["force", "strain", "stress", "seam_force"].into_iter().zip(numbers) {
        let value = value.unwrap_or(0.0);
        limits::within(&format!("{at}.{key}"), value, &(0.0..=MOST), "0 to 1e12")?;
    }
    limits::within(&format!("{at}.noise"), noise.unwrap_or(0.0), &(0.0..=1.0), "0 to 1")
}
