//! What a fabric is made of, in SI units, in the words of the scene file.

use boucle_geometry::Vector;

use crate::error::Result;
use crate::material::at_least_zero;

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
            damping_ratio: [0.02; 3],
            warp: Warp::Along(Vector::y()),
        }
    }
}

impl Fabric {
    /// Refuses values outside their domains, named as in the scene file.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`](crate::Error::OutOfDomain) for the first value that is not accepted.
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
        Ok(())
    }
}
