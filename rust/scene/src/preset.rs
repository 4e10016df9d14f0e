//! The fabrics that scenes may name: `presets/fabrics.toml`, each number with its source.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use boucle_solver::{DampingLaw, StiffnessFrom};
use serde::{Deserialize, Serialize};

use crate::description::Choice;
use crate::error::{Error, Result};
use crate::lattice::Lattice;
use crate::limits;

/// The file, as it stands in the program.
const FILE: &str = include_str!("../presets/fabrics.toml");

/// What is known of one fabric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FabricPreset {
    /// Where menus show it.
    pub group: String,
    /// What menus call it.
    pub title: String,
    /// Areal density (kg/m²).
    pub density: f64,
    /// How thick it is (m).
    pub thickness: f64,
    /// Tensile stiffness (N/m) along the warp.
    pub stretch_warp: f64,
    /// Tensile stiffness (N/m) along the weft.
    pub stretch_weft: f64,
    /// Stiffness (N/m) against compression along the warp, as stretch if missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compression_warp: Option<f64>,
    /// Stiffness (N/m) against compression along the weft, as stretch if missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compression_weft: Option<f64>,
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Bending stiffness (N·m) of curvature along the warp.
    pub bend_warp: f64,
    /// Bending stiffness (N·m) of curvature along the weft.
    pub bend_weft: f64,
    /// Coefficient of friction, cloth on cloth.
    pub friction: f64,
    /// Allowed elongation, as a fraction.
    pub deformation_rate: f64,
    /// Stress (N/m) at which it tears: its breaking force over the width of the strip, in the weaker direction.
    pub tear_stress: f64,
    /// Damping as a part of the critical, at a wavelength of 0.1 m.
    pub damping_ratio: f64,
    /// Between what its drape coefficient (%, Cusick) is said to lie, where anybody says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drape_coefficient: Option<[f64; 2]>,
    /// Where the numbers come from.
    pub source: String,
}

static PRESETS: LazyLock<BTreeMap<String, FabricPreset>> =
    LazyLock::new(|| toml::from_str(FILE).unwrap_or_default());

/// All fabrics, by name.
#[must_use]
pub fn fabric_presets() -> &'static BTreeMap<String, FabricPreset> {
    &PRESETS
}

/// The springs of a named fabric on a mesh of such edges (m) as a JSON object with the keys of `[cloth.springs]`.
///
/// # Errors
/// [`Error::Input`] for a name that no fabric has, and for a length that is not above 0.
pub fn fabric_springs_json(preset: &str, edge: f64) -> Result<String> {
    let Some(fabric) = fabric_presets().get(preset) else {
        let names: Vec<&str> = fabric_presets().keys().map(String::as_str).collect();
        return Err(Error::refuse("preset", format!("{preset:?}"), &names.join(", ")));
    };
    limits::above_zero("edge", edge, limits::MAX_LENGTH, " m")?;
    let Lattice { stiffness, damping } = fabric.lattice(edge);
    let springs = serde_json::json!({
        "stretch": stiffness[0], "shear": stiffness[1], "bend": stiffness[2],
        "damping_stretch": damping[0], "damping_shear": damping[1], "damping_bend": damping[2],
        "damping_law": DampingLaw::Axial.word(),
        "stiffness_from": StiffnessFrom::Continuum.word(),
        "deformation_rate": fabric.deformation_rate,
    });
    Ok(springs.to_string())
}

/// All fabrics as a JSON object of objects, whose keys are those of the file.
#[must_use]
pub fn fabric_presets_json() -> String {
    serde_json::to_string(fabric_presets()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_fabric_with_a_source() {
        let presets: BTreeMap<String, FabricPreset> = toml::from_str(FILE).expect("presets");
        assert!(presets.len() >= 24, "{}", presets.len());
        for (name, preset) in &presets {
            let stretch = [preset.stretch_warp, preset.stretch_weft];
            let compression = [
                preset.compression_warp.unwrap_or(stretch[0]),
                preset.compression_weft.unwrap_or(stretch[1]),
            ];
            let is_softer = compression.iter().zip(&stretch).all(|(one, other)| one <= other);
            assert!(is_softer, "{name} is compressed less easily than stretched");
            let fabric = boucle_solver::Fabric {
                stretch,
                compression,
                shear: preset.shear,
                bend: [preset.bend_warp, preset.bend_weft],
                damping_ratio: [preset.damping_ratio; 3],
                ..boucle_solver::Fabric::default()
            };
            fabric.check().unwrap_or_else(|error| panic!("{name}: {error}"));
            let is_cloth = (0.01..2.0).contains(&preset.density)
                && (5e-5..2e-2).contains(&preset.thickness)
                && (0.0..2.0).contains(&preset.friction)
                && (0.0..1.0).contains(&preset.deformation_rate)
                && (1e2..1e5).contains(&preset.tear_stress);
            assert!(is_cloth, "{name}: {preset:?}");
            assert!(preset.source.len() > 40, "{name} has no source");
            assert!(!preset.group.is_empty() && !preset.title.is_empty(), "{name}");
        }
    }
}
