//! `[[cloth]]`: its rest shape, mass, pins and springs.

use boucle_geometry::Vector;
use boucle_solver::{Mass, PinMaterial};
use serde::{Deserialize, Serialize};

use super::choice::Choice;
use super::collision::ClothCollision;
use super::fabric::{FabricDescription, WarpDescription};
use super::flow::ClothWater;
use super::pins::Pins;
use super::shape::{PressureDescription, SewingDescription, Shrink};
use super::springs::Springs;
use super::table;
use crate::error::{Error, Result};
use crate::limits;
use crate::preset::FabricPreset;

/// Areal density (kg/m²) of a cloth that names no mass.
const DEFAULT_DENSITY: f64 = 0.2;
/// Largest mass of a particle (kg) and areal density (kg/m²).
const MAX_MASS: f64 = 1e6;
/// Largest component of a velocity (m/s).
const MAX_SPEED: f64 = 1e4;

/// One cloth.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClothDescription {
    /// Names the files of the bake; no two cloths share it.
    pub name: String,
    /// The rest shape as a grid.
    #[serde(default, deserialize_with = "table::optional")]
    pub grid: Option<Grid>,
    /// The rest shape as an OBJ file, beside the scene file.
    pub mesh: Option<String>,
    /// An OBJ file with the same faces whose positions are the rest shape; the cloth starts from `grid` or `mesh`.
    pub rest: Option<String>,
    /// Which axis of the OBJ files points up.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub up: UpAxis,
    /// Where the rest shape stands.
    #[serde(default, deserialize_with = "table::one")]
    pub transform: Transform,
    /// Areal density (kg/m²).
    pub density: Option<f64>,
    /// Mass of each particle (kg).
    pub mass_per_vertex: Option<f64>,
    /// Vertices that do not move of themselves.
    #[serde(default)]
    pub pins: Pins,
    /// `[cloth.shrink]`.
    #[serde(default, deserialize_with = "table::optional")]
    pub shrink: Option<Shrink>,
    /// `[cloth.pressure]`.
    #[serde(default, deserialize_with = "table::optional")]
    pub pressure: Option<PressureDescription>,
    /// `[cloth.water]`.
    #[serde(default, deserialize_with = "table::one")]
    pub water: ClothWater,
    /// `[cloth.sewing]`.
    #[serde(default, deserialize_with = "table::optional")]
    pub sewing: Option<SewingDescription>,
    /// Stiffness (N/m) by which pins of weight 1 that hang together would be drawn, were they soft; a weight takes a part.
    pub pin_stiffness: Option<f64>,
    /// Damping of soft pins, as a multiple of the critical.
    pub pin_damping: Option<f64>,
    /// Velocity (m/s) of every vertex at the first frame, but for those that are pinned.
    #[serde(default)]
    pub velocity: [f64; 3],
    /// `[cloth.collision]`.
    #[serde(default, deserialize_with = "table::one")]
    pub collision: ClothCollision,
    /// Which model of cloth.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub model: Model,
    /// `[cloth.springs]`.
    #[serde(default, deserialize_with = "table::one")]
    pub springs: Springs,
    /// `[cloth.fabric]`.
    #[serde(default, deserialize_with = "table::one")]
    pub fabric: FabricDescription,
}

impl ClothDescription {
    /// The fabric that its model names, if it names one.
    #[must_use]
    pub fn named_fabric(&self) -> Option<&'static FabricPreset> {
        match self.model {
            Model::Springs => self.springs.named(),
            Model::Fabric => self.fabric.named(),
        }
    }

    /// Whether its mesh needs UV coordinates.
    #[must_use]
    pub fn is_mapped(&self) -> bool {
        self.model == Model::Fabric && self.fabric.warp == Some(WarpDescription::Uv)
    }

    /// The mass as the solver takes it.
    #[must_use]
    pub fn mass(&self) -> Mass {
        match (self.density, self.mass_per_vertex) {
            (_, Some(mass)) => Mass::PerVertex(mass),
            (density, None) => {
                let of_preset = self.named_fabric().map(|preset| preset.density);
                Mass::Density(density.or(of_preset).unwrap_or(DEFAULT_DENSITY))
            }
        }
    }

    /// What draws soft pins, as the solver takes it.
    #[must_use]
    pub fn pin_material(&self) -> PinMaterial {
        let default = PinMaterial::default();
        PinMaterial {
            stiffness: self.pin_stiffness.unwrap_or(default.stiffness),
            damping_ratio: self.pin_damping.unwrap_or(default.damping_ratio),
        }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        if self.name.is_empty() {
            return Err(Error::refuse(&format!("{at}.name"), "\"\"", "a name"));
        }
        if let (Some(_), Some(_)) = (&self.grid, &self.mesh) {
            return Err(Error::input(format!("{at}: grid and mesh; accepted: one of the two")));
        }
        if let Some(grid) = &self.grid {
            grid.check(&format!("{at}.grid"))?;
        }
        if self.up != UpAxis::Z && self.mesh.is_none() && self.rest.is_none() {
            return Err(Error::input(format!("{at}.up: accepted only with mesh")));
        }
        self.transform.check(&format!("{at}.transform"))?;
        if let (Some(_), Some(_)) = (self.density, self.mass_per_vertex) {
            let both = "density and mass_per_vertex; accepted: one of the two";
            return Err(Error::input(format!("{at}: {both}")));
        }
        if let Some(density) = self.density {
            limits::above_zero(&format!("{at}.density"), density, MAX_MASS, " kg/m²")?;
        }
        if let Some(mass) = self.mass_per_vertex {
            limits::above_zero(&format!("{at}.mass_per_vertex"), mass, MAX_MASS, " kg")?;
        }
        limits::vector(&format!("{at}.velocity"), &self.velocity, MAX_SPEED, " m/s")?;
        self.pins.check(&format!("{at}.pins"))?;
        if let Some(shrink) = &self.shrink {
            shrink.check(&format!("{at}.shrink"))?;
        }
        if let Some(pressure) = &self.pressure {
            pressure.check(&format!("{at}.pressure"))?;
        }
        if let Some(sewing) = &self.sewing {
            sewing.check(&format!("{at}.sewing"))?;
        }
        let material = self.pin_material();
        material.check().map_err(|error| Error::input(format!("{at}.{error}")))?;
        self.fabric.check(&format!("{at}.fabric"))?;
        self.springs.check(at)
    }
}

/// A rectangular grid of quads.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Lengths (m) along the first and the second axis of the plane.
    pub size: [f64; 2],
    /// Columns and rows of vertices.
    pub vertices: [u32; 2],
    /// The plane it lies in.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub plane: Plane,
    /// Its middle (m).
    #[serde(default)]
    pub center: [f64; 3],
}

impl Grid {
    fn check(&self, at: &str) -> Result<()> {
        for (axis, &size) in self.size.iter().enumerate() {
            limits::above_zero(&format!("{at}.size.{axis}"), size, limits::MAX_LENGTH, " m")?;
        }
        for (axis, &count) in self.vertices.iter().enumerate() {
            if count < 2 {
                return Err(Error::refuse(&format!("{at}.vertices.{axis}"), count, "2 or more"));
            }
        }
        let [columns, rows] = self.vertices.map(u64::from);
        limits::vertices(&format!("{at}.vertices"), columns * rows)?;
        limits::vector(&format!("{at}.center"), &self.center, limits::MAX_LENGTH, " m")
    }
}

/// The plane of a grid: its first axis (columns) and its second (rows), as indices of x, y, z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plane {
    /// Lying flat.
    Xy,
    /// Upright, facing y.
    #[default]
    Xz,
    /// Upright, facing x.
    Yz,
}

impl Plane {
    /// The axes of columns and rows: 0 x, 1 y, 2 z.
    #[must_use]
    pub fn axes(self) -> [usize; 2] {
        match self {
            Self::Xy => [0, 1],
            Self::Xz => [0, 2],
            Self::Yz => [1, 2],
        }
    }
}

impl Choice for Plane {
    const WORDS: &'static [(&'static str, Self)] =
        &[("xy", Self::Xy), ("xz", Self::Xz), ("yz", Self::Yz)];
}

/// Which axis of a mesh file points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// As in Blender: the file is read as it stands.
    #[default]
    Z,
    /// As in many other programs: y becomes z, z becomes -y.
    Y,
}

impl UpAxis {
    /// A point (m) of the file with z up.
    #[must_use]
    pub fn turned(self, point: Vector) -> Vector {
        match self {
            Self::Z => point,
            Self::Y => Vector::new(point.x, -point.z, point.y),
        }
    }
}

impl Choice for UpAxis {
    const WORDS: &'static [(&'static str, Self)] = &[("z", Self::Z), ("y", Self::Y)];
}

/// Where a rest shape stands: scaled, then turned, then moved.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Transform {
    /// Displacement (m).
    pub location: [f64; 3],
    /// Angles (degrees) about the world's x, then y, then z.
    pub rotation_deg: [f64; 3],
    /// Factor of every length.
    pub scale: f64,
}

impl Default for Transform {
    fn default() -> Self {
        Self { location: [0.0; 3], rotation_deg: [0.0; 3], scale: 1.0 }
    }
}

impl Transform {
    pub(super) fn check(&self, at: &str) -> Result<()> {
        limits::vector(&format!("{at}.location"), &self.location, limits::MAX_LENGTH, " m")?;
        limits::vector(&format!("{at}.rotation_deg"), &self.rotation_deg, 1e6, " degrees")?;
        limits::above_zero(&format!("{at}.scale"), self.scale, 1e6, "")
    }
}

/// Which model of cloth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// The classic mass-spring model.
    #[default]
    Springs,
    /// A continuum: a membrane that bends at hinges.
    Fabric,
}

impl Choice for Model {
    const WORDS: &'static [(&'static str, Self)] =
        &[("springs", Self::Springs), ("fabric", Self::Fabric)];
}
