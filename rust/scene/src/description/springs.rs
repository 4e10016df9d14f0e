//! `[cloth.springs]`: the classic mass-spring model.
//!
//! ```toml
//! [cloth.springs]                 # used by model = "springs"
//! preset = "denim"                # what is missing below, and density, friction and thickness of the cloth, are those of this
//!                                 # fabric: see crate::lattice
//! stretch = 500.0                 # N/m
//! shear = 100.0
//! bend = 5.0
//! damping = 1.0                   # N·s/m, every spring; or damping_stretch, damping_shear, damping_bend
//! damping_law = "relative"        # "relative" | "axial"
//! air_damping = 0.0               # N·s/m, viscous, every particle
//! stiffness_from = "springs"      # "continuum": the three numbers are those of a membrane
//! deformation_rate = 0.10         # allowed elongation
//! limiter = "project"             # "none" | "stiffen" | "provot" | "project"
//! ```

use boucle_solver::{DampingLaw, Limiter, SpringMaterial, StiffnessFrom};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::choice::Choice;
use super::fabric::check_preset;
use crate::error::{Error, Result};
use crate::preset::{FabricPreset, fabric_presets};

impl Choice for StiffnessFrom {
    const WORDS: &'static [(&'static str, Self)] =
        &[("springs", Self::Springs), ("continuum", Self::Continuum)];
}

impl Choice for DampingLaw {
    const WORDS: &'static [(&'static str, Self)] =
        &[("relative", Self::Relative), ("axial", Self::Axial)];
}

impl Choice for Limiter {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("none", Self::None),
        ("stiffen", Self::Stiffen),
        ("provot", Self::Provot),
        ("project", Self::Project),
    ];
}

/// The mass-spring material; what is missing is that of the preset, or the default.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Springs {
    /// A named fabric.
    pub preset: Option<String>,
    /// Stiffness (N/m) of stretch springs.
    pub stretch: Option<f64>,
    /// Stiffness (N/m) of shear springs.
    pub shear: Option<f64>,
    /// Stiffness (N/m) of bend springs.
    pub bend: Option<f64>,
    /// Damping (N·s/m) of every spring whose kind names none.
    pub damping: Option<f64>,
    /// Damping (N·s/m) of stretch springs.
    pub damping_stretch: Option<f64>,
    /// Damping (N·s/m) of shear springs.
    pub damping_shear: Option<f64>,
    /// Damping (N·s/m) of bend springs.
    pub damping_bend: Option<f64>,
    /// Which relative velocity is damped.
    #[serde(deserialize_with = "some_word", serialize_with = "word_or_null")]
    pub damping_law: Option<DampingLaw>,
    /// Viscous damping (N·s/m) of every particle by the air.
    pub air_damping: f64,
    /// What the stiffnesses are.
    #[serde(deserialize_with = "some_word", serialize_with = "word_or_null")]
    pub stiffness_from: Option<StiffnessFrom>,
    /// Allowed elongation, as a fraction of the rest length.
    pub deformation_rate: Option<f64>,
    /// What keeps to it.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub limiter: Limiter,
}

impl Springs {
    /// The named fabric, if one is named.
    #[must_use]
    pub fn named(&self) -> Option<&'static FabricPreset> {
        fabric_presets().get(self.preset.as_ref()?)
    }

    /// The material as the solver takes it, on a mesh whose edges are so long (m) in the mean.
    #[must_use]
    pub fn material(&self, edge: f64) -> SpringMaterial {
        let default = SpringMaterial::default();
        let preset = self.named();
        let lattice = preset.map(|preset| preset.lattice(edge));
        let stiffness = lattice.map_or(default.stiffness, |lattice| lattice.stiffness);
        let damping = lattice.map_or([self.damping.unwrap_or(0.0); 3], |lattice| {
            self.damping.map_or(lattice.damping, |own| [own; 3])
        });
        let own = [self.stretch, self.shear, self.bend];
        let kinds = [self.damping_stretch, self.damping_shear, self.damping_bend];
        let of_preset = preset.is_some().then_some((StiffnessFrom::Continuum, DampingLaw::Axial));
        let (stiffness_from, damping_law) =
            of_preset.unwrap_or((default.stiffness_from, default.damping_law));
        let rate = preset.map_or(default.deformation_rate, |preset| preset.deformation_rate);
        SpringMaterial {
            stiffness: [0, 1, 2].map(|kind| own[kind].unwrap_or(stiffness[kind])),
            stiffness_from: self.stiffness_from.unwrap_or(stiffness_from),
            damping: [0, 1, 2].map(|kind| kinds[kind].unwrap_or(damping[kind])),
            damping_law: self.damping_law.unwrap_or(damping_law),
            air_damping: self.air_damping,
            deformation_rate: self.deformation_rate.unwrap_or(rate),
            limiter: self.limiter,
        }
    }

    /// Refuses what cannot be; `at` is the key of the cloth.
    pub(super) fn check(&self, at: &str) -> Result<()> {
        check_preset(&format!("{at}.springs.preset"), self.preset.as_deref())?;
        // Of a preset's numbers, the edges' length changes what is accepted anyway.
        let material = self.material(1.0);
        material.check().map_err(|error| Error::input(format!("{at}.{error}")))
    }
}

fn some_word<'de, D: Deserializer<'de>, C: Choice>(
    from: D,
) -> std::result::Result<Option<C>, D::Error> {
    C::read(from).map(Some)
}

#[expect(clippy::ref_option, reason = "serde hands it so")]
fn word_or_null<S: Serializer, C: Choice>(
    choice: &Option<C>,
    to: S,
) -> std::result::Result<S::Ok, S::Error> {
    match choice {
        Some(choice) => C::write(choice, to),
        None => to.serialize_none(),
    }
}
