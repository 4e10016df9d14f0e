//! `[cloth.fabric]`: a continuum, in SI units.
//!
//! ```toml
//! [cloth.fabric]                  # used by model = "fabric"
//! stretch_warp = 2000.0           # N/m
//! stretch_weft = 2000.0
//! compression_warp = 2000.0       # N/m, as stretch if missing
//! compression_weft = 2000.0
//! shear = 100.0                   # N/m
//! bend_warp = 2e-5                # N·m
//! bend_weft = 2e-5
//! damping_ratio = 0.02            # of the critical, at a wavelength of 0.1 m; or damping_ratio_stretch, _shear, _bend
//! warp = [0.0, 1.0, 0.0]          # which way the warp runs, where no map says so
//! air_damping = 0.0               # N·s/m, viscous, every particle
//! deformation_rate = 0.05         # allowed elongation
//! limiter = "project"             # "none" | "provot" | "project"
//! ```

use boucle_geometry::Vector;
use boucle_solver::{Fabric, Limiter, SpringMaterial, Warp};
use serde::{Deserialize, Serialize};

use super::choice::Choice;
use crate::error::{Error, Result};
use crate::limits;

/// Allowed elongation of a fabric that names none.
const DEFORMATION_RATE: f64 = 0.05;

/// The material of one cloth of fabric; what is missing is that of the default fabric.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FabricDescription {
    /// Tensile stiffness (N/m) along the warp.
    pub stretch_warp: f64,
    /// Tensile stiffness (N/m) along the weft.
    pub stretch_weft: f64,
    /// Stiffness (N/m) against compression along the warp.
    pub compression_warp: Option<f64>,
    /// Stiffness (N/m) against compression along the weft.
    pub compression_weft: Option<f64>,
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Bending stiffness (N·m) of curvature along the warp.
    pub bend_warp: f64,
    /// Bending stiffness (N·m) of curvature along the weft.
    pub bend_weft: f64,
    /// Damping of every mode that names none, as a part of the critical.
    pub damping_ratio: f64,
    /// Damping of stretch.
    pub damping_ratio_stretch: Option<f64>,
    /// Damping of shear.
    pub damping_ratio_shear: Option<f64>,
    /// Damping of bending.
    pub damping_ratio_bend: Option<f64>,
    /// Which way the warp runs.
    pub warp: [f64; 3],
    /// Viscous damping (N·s/m) of every particle by the air.
    pub air_damping: f64,
    /// Allowed elongation, as a fraction of the rest length.
    pub deformation_rate: f64,
    /// What keeps to it.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub limiter: Limiter,
}

impl Default for FabricDescription {
    fn default() -> Self {
        let fabric = Fabric::default();
        let [stretch_warp, stretch_weft] = fabric.stretch;
        let [bend_warp, bend_weft] = fabric.bend;
        Self {
            stretch_warp,
            stretch_weft,
            compression_warp: None,
            compression_weft: None,
            shear: fabric.shear,
            bend_warp,
            bend_weft,
            damping_ratio: fabric.damping_ratio[0],
            damping_ratio_stretch: None,
            damping_ratio_shear: None,
            damping_ratio_bend: None,
            warp: [0.0, 1.0, 0.0],
            air_damping: 0.0,
            deformation_rate: DEFORMATION_RATE,
            limiter: Limiter::default(),
        }
    }
}

impl FabricDescription {
    /// The fabric as the solver takes it.
    #[must_use]
    pub fn fabric(&self) -> Fabric {
        let stretch = [self.stretch_warp, self.stretch_weft];
        let compression = [self.compression_warp, self.compression_weft];
        let ratios =
            [self.damping_ratio_stretch, self.damping_ratio_shear, self.damping_ratio_bend];
        Fabric {
            stretch,
            compression: [0, 1].map(|i| compression[i].unwrap_or(stretch[i])),
            shear: self.shear,
            bend: [self.bend_warp, self.bend_weft],
            damping_ratio: ratios.map(|ratio| ratio.unwrap_or(self.damping_ratio)),
            warp: Warp::Along(Vector::from(self.warp)),
        }
    }

    /// What springs and fabric have in common, as the solver takes it.
    #[must_use]
    pub fn material(&self) -> SpringMaterial {
        SpringMaterial {
            air_damping: self.air_damping,
            deformation_rate: self.deformation_rate,
            limiter: self.limiter,
            ..SpringMaterial::default()
        }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        limits::vector(&format!("{at}.warp"), &self.warp, limits::MAX_LENGTH, "")?;
        if self.warp == [0.0; 3] {
            return Err(Error::refuse(&format!("{at}.warp"), "[0, 0, 0]", "a direction"));
        }
        if self.limiter == Limiter::Stiffen {
            let accepted = "\"none\", \"provot\", \"project\" (\"stiffen\" stiffens springs)";
            return Err(Error::refuse(&format!("{at}.limiter"), "\"stiffen\"", accepted));
        }
        let named = |error: boucle_solver::Error| {
            let message = error.to_string();
            let message = message.replace("springs.", "fabric.");
            Error::input(format!("{}.{message}", at.trim_end_matches(".fabric")))
        };
        self.fabric().check().map_err(named)?;
        self.material().check().map_err(named)
    }
}
