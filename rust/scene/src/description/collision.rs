//! `[collision]` and `[cloth.collision]`: how cloth touches.
//!
//! The first holds for every cloth, the second for one, key by key. Cloth collides unless it is told not to.

use boucle_solver::Collision;
use serde::{Deserialize, Serialize};

use super::check_known;
use crate::error::{Error, Result};
use crate::limits;
use crate::preset::FabricPreset;

/// Largest thickness and radius (m) that the solver takes.
pub(super) const THICKEST: f64 = 100.0;
/// Largest coefficient of friction that the solver takes.
const ROUGHEST: f64 = 100.0;

/// `[collision]`: how every cloth collides that does not say otherwise.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CollisionDescription {
    /// Whether cloth touches anything.
    pub enabled: bool,
    /// Whether a cloth collides with itself.
    #[serde(rename = "self")]
    pub with_self: bool,
    /// Radius (m) of the cloth.
    pub thickness: Option<f64>,
    /// Coefficient of friction.
    pub friction: Option<f64>,
}

impl Default for CollisionDescription {
    fn default() -> Self {
        let with_self = Collision::default().with_self;
        Self { enabled: true, with_self, thickness: None, friction: None }
    }
}

impl CollisionDescription {
    pub(super) fn check(&self) -> Result<()> {
        check_numbers("collision", self.thickness, self.friction)
    }
}

/// `[cloth.collision]`: what one cloth does otherwise.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClothCollision {
    /// Whether it touches anything.
    pub enabled: Option<bool>,
    /// Whether it collides with itself.
    #[serde(rename = "self")]
    pub with_self: Option<bool>,
    /// Its radius (m).
    pub thickness: Option<f64>,
    /// Its coefficient of friction.
    pub friction: Option<f64>,
    /// Triangles with all corners among these vertices do not collide with their own cloth.
    pub excluded_from_self: Vec<u32>,
    /// Triangles with all corners among these vertices do not collide with colliders.
    pub excluded_from_colliders: Vec<u32>,
    /// The names of the colliders that it meets; all if missing.
    pub colliders: Option<Vec<String>>,
    /// The names of the other cloths that it meets, if they meet it, too; all if missing.
    pub cloths: Option<Vec<String>>,
}

impl ClothCollision {
    pub(super) fn check(&self, at: &str, colliders: &[&str], cloths: &[&str]) -> Result<()> {
        check_numbers(at, self.thickness, self.friction)?;
        let lists = [("colliders", &self.colliders, colliders), ("cloths", &self.cloths, cloths)];
        for (kind, chosen, known) in lists {
            for (index, name) in chosen.iter().flatten().enumerate() {
                check_known(&format!("{at}.{kind}.{index}"), name, known, kind)?;
            }
        }
        Ok(())
    }

    /// How a cloth of so many vertices collides, where `general` holds unless it says otherwise, and then the fabric it is
    /// named after; not at all if `None`. `at` is the key of this table.
    ///
    /// # Errors
    /// [`Error::Input`] for an excluded vertex that is not there.
    pub(crate) fn collision(
        &self,
        general: &CollisionDescription,
        preset: Option<&FabricPreset>,
        [colliders, cloths]: [&[&str]; 2],
        vertex_count: usize,
        at: &str,
    ) -> Result<Option<Collision>> {
        check_vertices(
            &format!("{at}.excluded_from_self"),
            &self.excluded_from_self,
            vertex_count,
        )?;
        let excluded = &self.excluded_from_colliders;
        check_vertices(&format!("{at}.excluded_from_colliders"), excluded, vertex_count)?;
        if !self.enabled.unwrap_or(general.enabled) {
            return Ok(None);
        }
        let met = |names: &Vec<String>, known: &[&str]| {
            let number = |name: &String| known.iter().position(|other| other == name);
            names.iter().filter_map(number).map(|number| number as u32).collect()
        };
        let default = Collision::default();
        // A fabric is twice as thick as it reaches from its middle.
        let of_preset = preset.map(|preset| [0.5 * preset.thickness, preset.friction]);
        let [thickness, friction] = of_preset.unwrap_or([default.thickness, default.friction]);
        Ok(Some(Collision {
            with_self: self.with_self.unwrap_or(general.with_self),
            thickness: self.thickness.or(general.thickness).unwrap_or(thickness),
            friction: self.friction.or(general.friction).unwrap_or(friction),
            excluded_from_self: self.excluded_from_self.clone(),
            excluded_from_colliders: excluded.clone(),
            colliders: self.colliders.as_ref().map(|names| met(names, colliders)),
            cloths: self.cloths.as_ref().map(|names| met(names, cloths)),
        }))
    }
}

fn check_vertices(at: &str, vertices: &[u32], count: usize) -> Result<()> {
    match vertices.iter().position(|&vertex| vertex as usize >= count) {
        Some(index) => Err(Error::refuse(
            &format!("{at}.{index}"),
            vertices[index],
            &format!("0 to {}", count.saturating_sub(1)),
        )),
        None => Ok(()),
    }
}

/// Refuses a thickness (m) of a cloth or a coefficient of friction beyond its range.
fn check_numbers(at: &str, thickness: Option<f64>, friction: Option<f64>) -> Result<()> {
    if let Some(thickness) = thickness {
        limits::above_zero(&format!("{at}.thickness"), thickness, THICKEST, " m")?;
    }
    friction.map_or(Ok(()), |friction| check_friction(at, friction))
}

/// Refuses a coefficient of friction beyond its range.
pub(super) fn check_friction(at: &str, friction: f64) -> Result<()> {
    limits::within(&format!("{at}.friction"), friction, &(0.0..=ROUGHEST), "0 to 100")
}
