//! What a spring cloth is made of, in the words of the scene file.

use crate::error::{Error, Result};

/// What a spring resists. The order is that of the arrays below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpringKind {
    /// Along a mesh edge.
    Stretch,
    /// Across a face, or across two triangles that share an edge.
    Shear,
    /// To the neighbour after next.
    Bend,
    /// Between the ends of a seam, which are drawn together: no spring of the mesh.
    Sewing,
}

impl SpringKind {
    /// Every kind that a mesh carries, in order.
    pub const ALL: [Self; 3] = [Self::Stretch, Self::Shear, Self::Bend];
}

/// How a spring damps the relative velocity of its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DampingLaw {
    /// `-kd (vi - vj)`: all of it (the paper).
    #[default]
    Relative,
    /// `-kd ((vi - vj)·n) n`: only along the spring (the course exercise).
    Axial,
}

/// What the three stiffnesses of a material are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StiffnessFrom {
    /// Those of the springs themselves (the paper).
    #[default]
    Springs,
    /// Those of a membrane; springs get theirs from the mesh, so that cloth is as stiff on any.
    Continuum,
}

/// What keeps springs below their allowed length `(1 + rate) L0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limiter {
    /// Nothing.
    None,
    /// Stiffer springs beyond the allowed length: `k L/L0`, the paper's equation 6 as printed. Its text once says that
    /// the factor is the ratio to the allowed length, `L/((1 + rate) L0)`; that reading stiffens less, and is not used.
    Stiffen,
    /// The ends of stretch and shear springs are moved back (Provot 1995).
    Provot,
    /// The ends of stretch springs are moved back and lose their separating velocity (after Zhong & Xu 2009).
    #[default]
    Project,
}

/// The mass-spring material of one cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringMaterial {
    /// Stiffness (N/m) of stretch, shear and bend springs.
    pub stiffness: [f64; 3],
    /// Whether those are the springs' own.
    pub stiffness_from: StiffnessFrom,
    /// Damping (N·s/m) of stretch, shear and bend springs.
    pub damping: [f64; 3],
    /// Which relative velocity is damped.
    pub damping_law: DampingLaw,
    /// Viscous damping (N·s/m) of every particle by the air.
    pub air_damping: f64,
    /// Allowed elongation, as a fraction of the rest length.
    pub deformation_rate: f64,
    /// What keeps to the deformation rate.
    pub limiter: Limiter,
}

impl Default for SpringMaterial {
    fn default() -> Self {
        Self {
            stiffness: [500.0, 100.0, 5.0],
            stiffness_from: StiffnessFrom::default(),
            damping: [0.0; 3],
            damping_law: DampingLaw::default(),
            air_damping: 0.0,
            deformation_rate: 0.10,
            limiter: Limiter::default(),
        }
    }
}

impl SpringMaterial {
    /// Refuses values outside their domains, named as in the scene file.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted.
    pub fn check(&self) -> Result<()> {
        let names = ["stretch", "shear", "bend"];
        for (kind, name) in names.iter().enumerate() {
            at_least_zero(&format!("springs.{name} (N/m)"), self.stiffness[kind])?;
            at_least_zero(&format!("springs.damping_{name} (N·s/m)"), self.damping[kind])?;
        }
        at_least_zero("springs.air_damping (N·s/m)", self.air_damping)?;
        if !(self.deformation_rate >= 0.0 && self.deformation_rate < 1.0) {
            return Err(Error::OutOfDomain {
                quantity: "springs.deformation_rate".to_owned(),
                value: self.deformation_rate,
                domain: "0 to below 1, as a fraction (did you mean 0.10 for 10 %?)",
            });
        }
        Ok(())
    }
}

/// What draws soft pins to their targets.
#[derive(Clone, Debug, PartialEq)]
pub struct PinMaterial {
    /// Stiffness (N/m) of all pins together that edges join, at weight 1; a weight below takes a part of it.
    pub stiffness: f64,
    /// Damping, as a multiple of what brings a pin alone to rest without swinging.
    pub damping_ratio: f64,
}

impl Default for PinMaterial {
    fn default() -> Self {
        Self { stiffness: 1000.0, damping_ratio: 1.0 }
    }
}

impl PinMaterial {
    /// Refuses values outside their domains, named as in the scene file.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted.
    pub fn check(&self) -> Result<()> {
        at_least_zero("pin_stiffness (N/m)", self.stiffness)?;
        at_least_zero("pin_damping", self.damping_ratio)
    }
}

/// Refuses what is not from 0 to 1.
pub(crate) fn within_one(quantity: &str, value: f64) -> Result<()> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfDomain { quantity: quantity.to_owned(), value, domain: "0 to 1" })
}

/// Refuses what is negative, not finite, or so large that its square overflows.
pub(crate) fn at_least_zero(quantity: &str, value: f64) -> Result<()> {
    if (0.0..=1e12).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfDomain { quantity: quantity.to_owned(), value, domain: "0 to 1e12" })
}
