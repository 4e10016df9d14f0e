//! `[cloth.fabric]`: a continuum, in SI units.
//!
//! ```toml
//! [cloth.fabric]                  # used by model = "fabric"
//! preset = "denim"                # what is missing below, and density, friction and thickness, are those of this fabric
//! stretch_warp = 2000.0           # N/m
//! stretch_weft = 2000.0
//! compression_warp = 2000.0       # N/m, as stretch if missing
//! compression_weft = 2000.0
//! shear = 100.0                   # N/m
//! bend_warp = 2e-5                # N·m
//! bend_weft = 2e-5
//! yield_curvature = 200.0         # 1/m, elastic curvature beyond which a crease stays; missing: nothing stays
//! hardening = 0.0                 # slope of the moment beyond it, as a part of the bending stiffness
//! bend_hysteresis = 0.0           # N·m/m, 2HB of the KES-FB2: how wide the loop of moment over curvature is
//! damping_ratio = 0.02            # of the critical, at a wavelength of 0.1 m; or damping_ratio_stretch, _shear, _bend
//! warp = [0.0, 1.0, 0.0]          # which way the warp runs; or "uv": where v of the mesh's UV coordinates grows
//! air_damping = 0.0               # N·s/m, viscous, every particle
//! deformation_rate = 0.05         # allowed elongation
//! limiter = "project"             # "none" | "provot" | "project"
//! ```

use std::fmt;

use boucle_geometry::Vector;
use boucle_solver::{Fabric, Limiter, SpringMaterial, Warp};
use serde::de::{Deserializer, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::choice::{Choice, nearest};
use crate::error::{Error, Result};
use crate::limits;
use crate::preset::{FabricPreset, fabric_presets};

/// Allowed elongation of a fabric that names none.
const DEFORMATION_RATE: f64 = 0.05;

/// The material of one cloth of fabric; what is missing is that of the preset, or of the default fabric.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FabricDescription {
    /// A named fabric.
    pub preset: Option<String>,
    /// Tensile stiffness (N/m) along the warp.
    pub stretch_warp: Option<f64>,
    /// Tensile stiffness (N/m) along the weft.
    pub stretch_weft: Option<f64>,
    /// Stiffness (N/m) against compression along the warp.
    pub compression_warp: Option<f64>,
    /// Stiffness (N/m) against compression along the weft.
    pub compression_weft: Option<f64>,
    /// Shear stiffness (N/m).
    pub shear: Option<f64>,
    /// Bending stiffness (N·m) of curvature along the warp.
    pub bend_warp: Option<f64>,
    /// Bending stiffness (N·m) of curvature along the weft.
    pub bend_weft: Option<f64>,
    /// Elastic curvature (1/m) beyond which a crease stays; nothing stays if missing.
    pub yield_curvature: Option<f64>,
    /// Slope of the moment beyond it, as a part of the bending stiffness.
    pub hardening: f64,
    /// 2HB of the KES-FB2 (N·m/m): how wide the loop of the moment by width over the curvature is.
    pub bend_hysteresis: f64,
    /// Damping of every mode that names none, as a part of the critical.
    pub damping_ratio: Option<f64>,
    /// Damping of stretch.
    pub damping_ratio_stretch: Option<f64>,
    /// Damping of shear.
    pub damping_ratio_shear: Option<f64>,
    /// Damping of bending.
    pub damping_ratio_bend: Option<f64>,
    /// Which way the warp runs.
    pub warp: Option<WarpDescription>,
    /// Viscous damping (N·s/m) of every particle by the air.
    pub air_damping: f64,
    /// Allowed elongation, as a fraction of the rest length.
    pub deformation_rate: Option<f64>,
    /// What keeps to it.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub limiter: Limiter,
}

impl FabricDescription {
    /// The named fabric, if one is named.
    #[must_use]
    pub fn named(&self) -> Option<&'static FabricPreset> {
        fabric_presets().get(self.preset.as_ref()?)
    }

    /// The fabric as the solver takes it, with the default's warp where that is by a map.
    #[must_use]
    pub fn fabric(&self) -> Fabric {
        let (preset, default) = (self.named(), Fabric::default());
        let number = |own: Option<f64>, of: fn(&FabricPreset) -> f64, default: f64| {
            own.or(preset.map(of)).unwrap_or(default)
        };
        let stretch = [
            number(self.stretch_warp, |preset| preset.stretch_warp, default.stretch[0]),
            number(self.stretch_weft, |preset| preset.stretch_weft, default.stretch[1]),
        ];
        let compression = [
            self.compression_warp.or(preset.and_then(|preset| preset.compression_warp)),
            self.compression_weft.or(preset.and_then(|preset| preset.compression_weft)),
        ];
        let all =
            number(self.damping_ratio, |preset| preset.damping_ratio, default.damping_ratio[0]);
        let ratios =
            [self.damping_ratio_stretch, self.damping_ratio_shear, self.damping_ratio_bend];
        Fabric {
            stretch,
            compression: [0, 1].map(|i| compression[i].unwrap_or(stretch[i])),
            shear: number(self.shear, |preset| preset.shear, default.shear),
            bend: [
                number(self.bend_warp, |preset| preset.bend_warp, default.bend[0]),
                number(self.bend_weft, |preset| preset.bend_weft, default.bend[1]),
            ],
            yield_curvature: self.yield_curvature,
            hardening: self.hardening,
            bend_hysteresis: self.bend_hysteresis,
            damping_ratio: ratios.map(|ratio| ratio.unwrap_or(all)),
            warp: match self.warp {
                Some(WarpDescription::Along(warp)) => Warp::Along(Vector::from(warp)),
                Some(WarpDescription::Uv) | None => default.warp,
            },
        }
    }

    /// What springs and fabric have in common, as the solver takes it.
    #[must_use]
    pub fn material(&self) -> SpringMaterial {
        let of_preset = self.named().map(|preset| preset.deformation_rate);
        SpringMaterial {
            air_damping: self.air_damping,
            deformation_rate: self.deformation_rate.or(of_preset).unwrap_or(DEFORMATION_RATE),
            limiter: self.limiter,
            ..SpringMaterial::default()
        }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        check_preset(&format!("{at}.preset"), self.preset.as_deref())?;
        if let Some(WarpDescription::Along(warp)) = &self.warp {
            limits::vector(&format!("{at}.warp"), warp, limits::MAX_LENGTH, "")?;
            if Vector::from(*warp).norm() <= 0.0 {
                return Err(Error::refuse(&format!("{at}.warp"), "[0, 0, 0]", "a direction"));
            }
        }
        if self.limiter == Limiter::Stiffen {
            let accepted = "\"none\", \"provot\", \"project\" (\"stiffen\" stiffens springs)";
            return Err(Error::refuse(&format!("{at}.limiter"), "\"stiffen\"", accepted));
        }
        let named = |error: boucle_solver::Error| {
            let message = error.to_string().replace("springs.", "fabric.");
            Error::input(format!("{}.{message}", at.trim_end_matches(".fabric")))
        };
        self.fabric().check().map_err(named)?;
        self.material().check().map_err(named)
    }
}

/// Refuses a name that no fabric has.
pub(super) fn check_preset(at: &str, name: Option<&str>) -> Result<()> {
    let Some(name) = name.filter(|&name| !fabric_presets().contains_key(name)) else {
        return Ok(());
    };
    let names = fabric_presets().keys().map(String::as_str);
    let accepted = match nearest(name, names.clone()) {
        Some(near) => format!("one of {} fabrics (did you mean \"{near}\"?)", names.len()),
        None => names.collect::<Vec<_>>().join(", "),
    };
    Err(Error::refuse(at, format!("{name:?}"), &accepted))
}

/// Which way the warp runs, in the words of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WarpDescription {
    /// Along a direction, as far as it lies in each face.
    Along([f64; 3]),
    /// Where v of the mesh's UV coordinates grows.
    Uv,
}

impl Serialize for WarpDescription {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Along(direction) => direction.serialize(serializer),
            Self::Uv => serializer.serialize_str("uv"),
        }
    }
}

impl<'de> Deserialize<'de> for WarpDescription {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(WarpVisitor)
    }
}

struct WarpVisitor;

impl<'de> Visitor<'de> for WarpVisitor {
    type Value = WarpDescription;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"uv\", or 3 numbers")
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> std::result::Result<Self::Value, E> {
        match word {
            "uv" => Ok(WarpDescription::Uv),
            other => Err(E::invalid_value(Unexpected::Str(other), &self)),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(
        self,
        mut list: A,
    ) -> std::result::Result<Self::Value, A::Error> {
        let mut direction = Vec::new();
        while let Some(number) = list.next_element()? {
            direction.push(number);
        }
        match direction.try_into() {
            Ok(direction) => Ok(WarpDescription::Along(direction)),
            Err(others) => Err(serde::de::Error::invalid_length(others.len(), &self)),
        }
    }
}
