//! What a fabric is made of, in SI units, in the words of the scene file.

use boucle_geometry::Vector;

use crate::error::{Error, Result};
use crate::material::at_least_zero;

/// The change of curvature (1/m) over which friction turns over, when cloth that was bent one way is bent the other: 0.5 /cm,
/// where the KES-FB2 reads the width of a loop, so that it is whole there even if the loop turns at 1 /cm. A shorter way
/// would make the fabric stiffer against small motions.
const TURN: f64 = 50.0;

/// The largest hardening: at 1 nothing would ever stay.
const MOST_HARDENING: f64 = 0.99;

/// Which way the warp runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Warp {
    /// Along a direction, as far as it lies in each face.
    Along(Vector),
    /// Along the second coordinate of a map: (u, v) of each corner of each face, as faces list them.
    Mapped(Vec<[f64; 2]>),
}

/// An orthotropic fabric: a membrane of triangles that bends at their common edges.
///
/// With the Green strain `E` of a triangle in its frame of warp and weft, and the curvature `K` of the surface, each unit of
/// its area stores
///
/// ```text
/// 1/2 (Y_warp E_ww² + Y_weft E_ff² + G (2 E_wf)²)
///     + 1/2 (B_warp K_ww² + B_weft K_ff² + 2 sqrt(B_warp B_weft) K_wf²)          (J/m²)
/// ```
///
/// Source: Volino, Magnenat-Thalmann & Faure 2009 for the membrane.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// Tensile stiffness Y (N/m) along warp and weft.
    pub stretch: [f64; 2],
    /// The same where it is compressed.
    pub compression: [f64; 2],
    /// Shear stiffness G (N/m).
    pub shear: f64,
    /// Bending stiffness B (N·m) of curvature along warp and weft.
    pub bend: [f64; 2],
    /// The elastic curvature (1/m) beyond which bending stays, as a crease; none if nothing stays.
    pub yield_curvature: Option<f64>,
    /// The slope of the moment over the curvature of a fabric that is creased further, as a part of the bending stiffness.
    pub hardening: f64,
    /// Friction against bending, the KES-FB2's 2HB (N·m/m): by how much the moment by width is less where cloth unbends than
    /// where it bends.
    pub bend_hysteresis: f64,
    /// Damping of stretch, shear and bend, as a part of the critical at a wavelength of 0.1 m.
    pub damping_ratio: [f64; 3],
    /// Which way the warp runs.
    pub warp: Warp,
}

impl Default for Fabric {
    fn default() -> Self {
        Self {
            stretch: [2000.0; 2],
            compression: [2000.0; 2],
            shear: 100.0,
            bend: [2e-5; 2],
            yield_curvature: None,
            hardening: 0.0,
            bend_hysteresis: 0.0,
            damping_ratio: [0.02; 3],
            warp: Warp::Along(Vector::y()),
        }
    }
}

impl Fabric {
    /// Refuses values outside their domains, named as in the scene file.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted.
    pub fn check(&self) -> Result<()> {
        for (i, yarn) in ["warp", "weft"].iter().enumerate() {
            at_least_zero(&format!("fabric.stretch_{yarn} (N/m)"), self.stretch[i])?;
            at_least_zero(&format!("fabric.compression_{yarn} (N/m)"), self.compression[i])?;
            at_least_zero(&format!("fabric.bend_{yarn} (N·m)"), self.bend[i])?;
        }
        at_least_zero("fabric.shear (N/m)", self.shear)?;
        for (ratio, kind) in self.damping_ratio.iter().zip(["stretch", "shear", "bend"]) {
            at_least_zero(&format!("fabric.damping_ratio_{kind}"), *ratio)?;
        }
        if let Some(curvature) = self.yield_curvature {
            at_least_zero("fabric.yield_curvature (1/m)", curvature)?;
        }
        at_least_zero("fabric.bend_hysteresis (N·m/m)", self.bend_hysteresis)?;
        if !(0.0..=MOST_HARDENING).contains(&self.hardening) {
            return Err(Error::OutOfDomain {
                quantity: "fabric.hardening".to_owned(),
                value: self.hardening,
                domain: "0 to 0.99, as a part of the bending stiffness",
            });
        }
        Ok(())
    }

    /// Whether bending leaves anything behind.
    pub(super) fn yields(&self) -> bool {
        self.yield_curvature.is_some() || self.bend_hysteresis > 0.0
    }

    /// Bending stiffness (N·m) along warp and weft as long as friction holds.
    pub(super) fn holding_bend(&self) -> [f64; 2] {
        self.bend.map(|bend| bend + self.bend_hysteresis / TURN)
    }
}
