//! `[[force]]`: what pushes the cloth besides gravity. Wind and water ([`super::flow`]), and force fields ([`super::field`]).

use boucle_geometry::{Aabb, Vector};
use boucle_solver::{Field, FieldShape, Region, Water, Wind};
use serde::{Deserialize, Serialize};

use super::check_known;
use super::choice::Choice;
use super::field::{FalloffDescription, field_of};
use super::flow::{
    GustsDescription, TurbulenceDescription, WaveDescription, law_of, water_of, weather_of,
};
use super::table;
use crate::error::{Error, Result};
use crate::limits;

/// Largest wind coefficient (N·s/m) and air density (kg/m³).
const MAX_COEFFICIENT: f64 = 1e6;
/// Largest component of the wind's velocity (m/s).
const MAX_SPEED: f64 = 1e4;

/// One force. Every kind has keys of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// Which force.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub kind: ForceKind,
    /// Wind: mean velocity (m/s) of the air. Water: of its current; at rest if missing.
    pub velocity: Option<[f64; 3]>,
    /// Wind: the classic law by vertex normal (N·s/m).
    pub coefficient: Option<f64>,
    /// Wind: pressure on faces, by the density (kg/m³) of the air.
    pub air_density: Option<f64>,
    /// By face: drag coefficient; 1 if missing.
    pub drag_coefficient: Option<f64>,
    /// By face: lift coefficient; pressure along the normal alone if missing.
    pub lift_coefficient: Option<f64>,
    /// By face: friction coefficient of both sides; none in air and 0.01 in water if missing.
    pub friction_coefficient: Option<f64>,
    /// Wind: gusts.
    #[serde(default, deserialize_with = "table::optional")]
    pub gusts: Option<GustsDescription>,
    /// Wind: turbulence.
    #[serde(default, deserialize_with = "table::optional")]
    pub turbulence: Option<TurbulenceDescription>,
    /// Wind: still air behind colliders.
    pub shelter: Option<bool>,
    /// Water: height (m) of the calm surface; 0 if missing.
    pub level: Option<f64>,
    /// Water: its density (kg/m³); 1000 if missing.
    pub density: Option<f64>,
    /// Water: waves on it.
    #[serde(default, deserialize_with = "table::list")]
    pub waves: Vec<WaveDescription>,
    /// Where wind blows; everywhere if missing.
    #[serde(default, deserialize_with = "table::optional")]
    pub region: Option<RegionDescription>,
    /// How strong a field is.
    pub strength: Option<f64>,
    /// Pressure (N/m²) of a field's strength of 1; 1 if missing.
    pub pressure: Option<f64>,
    /// Part of a field that is let through; 1 if missing.
    pub weight: Option<f64>,
    /// Drag: its part for each m/s. Harmonic: its damping.
    pub damping: Option<f64>,
    /// How a field slows what moves, less 1 for each m/s.
    pub flow: Option<f64>,
    /// Random part of a field's strength.
    pub noise: Option<f64>,
    /// Chooses the random numbers.
    pub seed: Option<u32>,
    /// Part of a field that acts along the cloth's normal alone.
    pub wind_factor: Option<f64>,
    /// Where a field stands (m); at the origin if missing.
    pub location: Option<[f64; 3]>,
    /// Its direction; upward if missing.
    pub axis: Option<[f64; 3]>,
    /// From where it acts.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub shape: FieldShape,
    /// How it fades.
    #[serde(default, deserialize_with = "table::optional")]
    pub falloff: Option<FalloffDescription>,
    /// Point: divided by the square of the distance, too.
    pub inverse_square: Option<bool>,
    /// Turbulence: size (m) of the largest eddies.
    pub size: Option<f64>,
    /// Turbulence: eddies stay where they are when the field moves.
    pub global: Option<bool>,
    /// Harmonic: distance (m) without force.
    pub rest_length: Option<f64>,
}

/// Which force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceKind {
    /// Moving air.
    Wind,
    /// Water up to a surface.
    Water,
    /// A field.
    Field(FieldWord),
}

/// Which field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldWord {
    /// Away from it.
    Point,
    /// Along its axis.
    Wind,
    /// Around its axis.
    Vortex,
    /// Any way.
    Turbulence,
    /// Against the velocity.
    Drag,
    /// Back to it.
    Harmonic,
    /// Across the velocity.
    Magnetic,
}

impl Choice for ForceKind {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("wind", Self::Wind),
        ("water", Self::Water),
        ("point", Self::Field(FieldWord::Point)),
        ("wind_field", Self::Field(FieldWord::Wind)),
        ("vortex", Self::Field(FieldWord::Vortex)),
        ("turbulence", Self::Field(FieldWord::Turbulence)),
        ("drag", Self::Field(FieldWord::Drag)),
        ("harmonic", Self::Field(FieldWord::Harmonic)),
        ("magnetic", Self::Field(FieldWord::Magnetic)),
    ];
}

/// Where a force acts: a box of the world, or a cloth, or vertices of that or of every cloth.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionDescription {
    /// Its smallest and its largest corner (m).
    pub r#box: Option<[[f64; 3]; 2]>,
    /// Vertex numbers, from 0.
    pub vertices: Option<Vec<u32>>,
    /// The name of the one cloth it acts on.
    pub cloth: Option<String>,
}

impl Force {
    /// The wind that it is, as the solver takes it, among cloths of these names; `None` for another force.
    ///
    /// # Errors
    /// When its keys do not make one law.
    pub fn wind(&self, at: &str, cloths: &[&str]) -> Result<Option<Wind>> {
        if self.kind != ForceKind::Wind {
            return Ok(None);
        }
        let Some(velocity) = self.velocity else {
            return Err(Error::input(format!("{at}.velocity is missing")));
        };
        let region =
            self.region.as_ref().map_or(Region::Everywhere, |region| region.region(cloths));
        let (gusts, turbulence) = weather_of(self);
        let (law, is_sheltered) = (law_of(self, at)?, self.shelter.unwrap_or_default());
        let velocity = Vector::from(velocity);
        Ok(Some(Wind { velocity, law, region, gusts, turbulence, is_sheltered }))
    }

    /// The water that it is; `None` for another force.
    ///
    /// # Errors
    /// When a value is out of its domain.
    pub fn water(&self, at: &str) -> Result<Option<Water>> {
        if self.kind == ForceKind::Water { water_of(self, at).map(Some) } else { Ok(None) }
    }

    /// The field that it is; `None` for another force.
    ///
    /// # Errors
    /// When a value is out of its domain.
    pub fn field(&self, at: &str) -> Result<Option<Field>> {
        let ForceKind::Field(word) = self.kind else { return Ok(None) };
        field_of(word, self, at).map(Some)
    }

    pub(super) fn check(&self, at: &str, cloths: &[&str]) -> Result<()> {
        self.refuse_foreign_keys(at)?;
        self.field(at)?;
        self.water(at)?;
        if let Some(velocity) = &self.velocity {
            limits::vector(&format!("{at}.velocity"), velocity, MAX_SPEED, " m/s")?;
        }
        if let Some(wind) = self.wind(at, cloths)? {
            wind.check_weather().map_err(|error| Error::input(format!("{at}: {error}")))?;
        }
        let numbers = [("coefficient", self.coefficient), ("air_density", self.air_density)];
        for (key, value) in numbers {
            if let Some(value) = value {
                let range = 0.0..=MAX_COEFFICIENT;
                limits::within(&format!("{at}.{key}"), value, &range, "0 to 1e6")?;
            }
        }
        let region = self.region.as_ref();
        region.map_or(Ok(()), |region| region.check(&format!("{at}.region"), cloths))
    }

    /// Refuses keys that forces of this kind do not have.
    fn refuse_foreign_keys(&self, at: &str) -> Result<()> {
        let given = self.keys();
        match given.iter().find(|(_, is_given, is_known)| *is_given && !is_known) {
            Some((key, ..)) => {
                let known = given.iter().filter(|(.., is_known)| *is_known).map(|(key, ..)| *key);
                let known = known.collect::<Vec<_>>().join(", ");
                let kind = self.kind.word();
                Err(Error::input(format!("{at}.{key} is no key of \"{kind}\"; accepted: {known}")))
            }
            None => Ok(()),
        }
    }

    /// Every key but the kind: whether it is given, and whether forces of this kind have it.
    fn keys(&self) -> [(&'static str, bool, bool); 29] {
        use FieldWord::{Drag, Harmonic, Point, Turbulence};
        let is_field = matches!(self.kind, ForceKind::Field(_));
        let (is_wind, is_water) = (self.kind == ForceKind::Wind, self.kind == ForceKind::Water);
        let is = |word| self.kind == ForceKind::Field(word);
        [
            ("velocity", self.velocity.is_some(), !is_field),
            ("coefficient", self.coefficient.is_some(), is_wind),
            ("air_density", self.air_density.is_some(), is_wind),
            ("drag_coefficient", self.drag_coefficient.is_some(), !is_field),
            ("lift_coefficient", self.lift_coefficient.is_some(), !is_field),
            ("friction_coefficient", self.friction_coefficient.is_some(), !is_field),
            ("region", self.region.is_some(), is_wind),
            ("gusts", self.gusts.is_some(), is_wind),
            ("turbulence", self.turbulence.is_some(), is_wind),
            ("shelter", self.shelter.is_some(), is_wind),
            ("level", self.level.is_some(), is_water),
            ("density", self.density.is_some(), is_water),
            ("waves", !self.waves.is_empty(), is_water),
            ("strength", self.strength.is_some(), is_field),
            ("pressure", self.pressure.is_some(), is_field),
            ("weight", self.weight.is_some(), is_field),
            ("noise", self.noise.is_some(), is_field),
            ("seed", self.seed.is_some(), is_field),
            ("wind_factor", self.wind_factor.is_some(), is_field),
            ("location", self.location.is_some(), is_field),
            ("axis", self.axis.is_some(), is_field),
            ("shape", self.shape != FieldShape::Point, is_field),
            ("falloff", self.falloff.is_some(), is_field),
            ("flow", self.flow.is_some(), is_field && !is(Drag) && !is(Harmonic)),
            ("damping", self.damping.is_some(), is(Drag) || is(Harmonic)),
            ("inverse_square", self.inverse_square.is_some(), is(Point)),
            ("size", self.size.is_some(), is(Turbulence)),
            ("global", self.global.is_some(), is(Turbulence)),
            ("rest_length", self.rest_length.is_some(), is(Harmonic)),
        ]
    }
}

impl RegionDescription {
    fn region(&self, cloths: &[&str]) -> Region {
        if let Some([min, max]) = self.r#box {
            return Region::Box(Aabb { min: Vector::from(min), max: Vector::from(max) });
        }
        match &self.cloth {
            None => Region::Vertices(self.vertices.clone().unwrap_or_default()),
            Some(name) => {
                let number = cloths.iter().position(|cloth| cloth == name);
                Region::Cloth(number.unwrap_or(cloths.len()) as u32, self.vertices.clone())
            }
        }
    }

    fn check(&self, at: &str, cloths: &[&str]) -> Result<()> {
        let of_cloth = self.vertices.is_some() || self.cloth.is_some();
        match (&self.r#box, of_cloth) {
            (Some(_), true) | (None, false) => {
                Err(Error::input(format!("{at} accepts either box or vertices, cloth or both")))
            }
            (None, true) => match &self.cloth {
                Some(name) => check_known(&format!("{at}.cloth"), name, cloths, "cloths"),
                None => Ok(()),
            },
            (Some([min, max]), false) => {
                limits::vector(&format!("{at}.box.0"), min, f64::MAX, " m")?;
                limits::vector(&format!("{at}.box.1"), max, f64::MAX, " m")?;
                match (0..3).find(|&axis| min[axis] > max[axis]) {
                    Some(axis) => Err(Error::refuse(
                        &format!("{at}.box.1.{axis}"),
                        format!("{:?}", max[axis]),
                        &format!("{:?} or more, as in the first corner", min[axis]),
                    )),
                    None => Ok(()),
                }
            }
        }
    }
}
