//! How a cloth touches: itself, other cloths, colliders.

use crate::error::{Error, Result};

/// How one cloth collides.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// Whether it collides with itself.
    pub with_self: bool,
    /// Its radius (m): two cloths keep the sum of theirs between them.
    pub thickness: f64,
    /// Coefficient of friction; that of a pair is the geometric mean of both.
    pub friction: f64,
    /// Triangles with all corners among these vertices do not collide with their own cloth.
    pub excluded_from_self: Vec<u32>,
    /// Triangles with all corners among these vertices do not collide with colliders.
    pub excluded_from_colliders: Vec<u32>,
    /// The colliders that it meets, by number; all if `None`.
    pub colliders: Option<Vec<u32>>,
    /// The other cloths that it meets, by number, if they meet it, too; all if `None`.
    pub cloths: Option<Vec<u32>>,
}

impl Default for Collision {
    fn default() -> Self {
        Self {
            with_self: true,
            thickness: 0.002,
            friction: 0.3,
            excluded_from_self: Vec::new(),
            excluded_from_colliders: Vec::new(),
            colliders: None,
            cloths: None,
        }
    }
}

/// Largest thickness (m) and coefficient of friction that are taken.
pub(crate) const THICKEST: f64 = 100.0;
const ROUGHEST: f64 = 100.0;

impl Collision {
    /// Refuses values outside their domains, for a cloth of a name and so many vertices among so many colliders and cloths.
    pub(crate) fn check(
        &self,
        cloth: &str,
        vertices: usize,
        [colliders, cloths]: [usize; 2],
    ) -> Result<()> {
        let owner = format!("cloth \"{cloth}\"");
        check_number(&owner, "thickness (m)", self.thickness, false)?;
        check_number(&owner, "friction", self.friction, true)?;
        let refuse = |what: &str, number: u32, count: usize| {
            let reason = format!("{what} {number} is not there; accepted: below {count}");
            Err(Error::BadCloth { cloth: cloth.to_owned(), reason })
        };
        let excluded = self.excluded_from_self.iter().chain(&self.excluded_from_colliders);
        for &vertex in excluded {
            if vertex as usize >= vertices {
                return refuse("excluded vertex", vertex, vertices);
            }
        }
        for &collider in self.colliders.iter().flatten() {
            if collider as usize >= colliders {
                return refuse("collider", collider, colliders);
            }
        }
        for &other in self.cloths.iter().flatten() {
            if other as usize >= cloths {
                return refuse("cloth", other, cloths);
            }
        }
        Ok(())
    }
}

/// Refuses a thickness or a coefficient of friction beyond its domain.
pub(crate) fn check_number(owner: &str, what: &str, value: f64, may_be_zero: bool) -> Result<()> {
    let (most, domain) = match what {
        "friction" => (ROUGHEST, "0 to 100"),
        _ if may_be_zero => (THICKEST, "0 to 100"),
        _ => (THICKEST, "above 0, at most 100"),
    };
    let is_large_enough = if may_be_zero { value >= 0.0 } else { value > 0.0 };
    if is_large_enough && value <= most {
        return Ok(());
    }
    Err(Error::OutOfDomain { quantity: format!("{owner}: {what}"), value, domain })
}
