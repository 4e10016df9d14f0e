//! Wind: the air pushes along the cloth's normal.
//!
//! For wind velocity u (m/s), a particle's velocity v and its normal n, the mean of its faces' normals:
//!
//! ```text
//! F = kw ((u - v)·n) n                            (N)  on each particle: the classic law
//! F = 1/2 rho A Cd |(u - v)·n| ((u - v)·n) n      (N)  on each face of area A: see [`super::flow`]
//! ```
//!
//! The force of a face is shared equally by its corners. A region limits the wind to a box in space, where a
//! particle feels it while it is inside, or to some vertices, of every cloth or of one. What is under water feels none.
//!
//! The velocity u changes with gusts and turbulence ([`super::weather`]), and may be none behind colliders
//! ([`super::shelter`]).
//!
//! Source: Provot 1995 for the first law; the second is the pressure of a flow on a plate.

use boucle_geometry::{Aabb, Vector};

use super::flow::Flow;
use super::weather::{Gusts, Turbulence};
use crate::cloth::Cloth;
use crate::error::{Error, Result};
use crate::material::at_least_zero;

/// How wind becomes force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindLaw {
    /// By particle, the classic law.
    Vertex {
        /// Force of a particle for each unit of wind speed (N·s/m).
        coefficient: f64,
    },
    /// By face: what the flow does to it.
    Face(Flow),
}

/// Where wind blows.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Everywhere.
    Everywhere,
    /// Inside a box in space.
    Box(Aabb),
    /// On these vertices of every cloth.
    Vertices(Vec<u32>),
    /// On one cloth, by number: on these of its vertices, on all if `None`.
    Cloth(u32, Option<Vec<u32>>),
}

/// A wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    /// Mean velocity of the air (m/s).
    pub velocity: Vector,
    /// How it becomes force.
    pub law: WindLaw,
    /// Where it blows.
    pub region: Region,
    /// Adds gusts.
    pub gusts: Option<Gusts>,
    /// Adds turbulence.
    pub turbulence: Option<Turbulence>,
    /// Whether the air is still behind colliders.
    pub is_sheltered: bool,
}

impl Default for Wind {
    /// Still air of 1.2 kg/m³ that presses on faces.
    fn default() -> Self {
        Self {
            velocity: Vector::zeros(),
            law: WindLaw::Face(Flow::new(1.2)),
            region: Region::Everywhere,
            gusts: None,
            turbulence: None,
            is_sheltered: false,
        }
    }
}

impl Wind {
    /// No gust and no eddy is faster (m/s).
    pub(super) fn most_speed(&self) -> f64 {
        let gust = 1.0 + self.gusts.map_or(0.0, |gusts| gusts.strength);
        let eddy = self.turbulence.map_or(0.0, |turbulence| 3.0_f64.sqrt() * turbulence.most());
        self.velocity.norm() * (gust + eddy)
    }

    /// Refuses coefficients, gusts and turbulence outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted.
    pub fn check_weather(&self) -> Result<()> {
        if let WindLaw::Face(flow) = self.law {
            flow.check("air")?;
        }
        self.gusts.as_ref().map_or(Ok(()), Gusts::check)?;
        self.turbulence.as_ref().map_or(Ok(()), Turbulence::check)
    }

    /// Refuses values outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] or [`Error::BadCloth`] for the first thing that is not accepted.
    pub fn check(&self, cloths: &[Cloth]) -> Result<()> {
        match self.law {
            WindLaw::Vertex { coefficient } => {
                at_least_zero("wind coefficient (N·s/m)", coefficient)?;
            }
            WindLaw::Face(_) => {}
        }
        check_velocity(&self.velocity)?;
        self.check_weather()?;
        let (cloths, vertices) = match &self.region {
            Region::Everywhere | Region::Box(_) => return Ok(()),
            Region::Vertices(vertices) => (cloths, vertices.as_slice()),
            Region::Cloth(cloth, vertices) => match cloths.get(*cloth as usize) {
                Some(cloth) => (std::slice::from_ref(cloth), vertices.as_deref().unwrap_or(&[])),
                None => {
                    return Err(Error::OutOfDomain {
                        quantity: "the cloth of a wind".to_owned(),
                        value: f64::from(*cloth),
                        domain: "the number of a cloth",
                    });
                }
            },
        };
        for cloth in cloths {
            let count = cloth.positions.len();
            if let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= count) {
                return Err(Error::BadCloth {
                    cloth: cloth.name.clone(),
                    reason: format!(
                        "the wind's region names vertex {vertex}; accepted: 0 to {}",
                        count - 1
                    ),
                });
            }
        }
        Ok(())
    }
}

/// Refuses the velocity (m/s) of a wind that no simulation takes.
pub(crate) fn check_velocity(velocity: &Vector) -> Result<()> {
    match velocity.iter().find(|speed| !(speed.abs() <= 1e4)) {
        None => Ok(()),
        Some(&value) => {
            let quantity = "wind velocity (m/s)".to_owned();
            Err(Error::OutOfDomain { quantity, value, domain: "-1e4 to 1e4" })
        }
    }
}

/// Which particles a region of vertices holds.
pub(super) fn vertex_mask(region: &Region, cloths: &[Cloth]) -> Option<Vec<bool>> {
    let (of, vertices) = match region {
        Region::Everywhere | Region::Box(_) => return None,
        Region::Vertices(vertices) => (None, Some(vertices)),
        Region::Cloth(cloth, vertices) => (Some(*cloth as usize), vertices.as_ref()),
    };
    let mut mask = Vec::new();
    for (number, cloth) in cloths.iter().enumerate() {
        let base = mask.len();
        let is_of = of.is_none_or(|of| of == number);
        mask.resize(base + cloth.positions.len(), is_of && vertices.is_none());
        if let Some(vertices) = vertices.filter(|_| is_of) {
            for vertex in cloth.pieces_of(vertices) {
                mask[base + vertex as usize] = true;
            }
        }
    }
    Some(mask)
}
