//! Colliders: what cloth touches and does not move.
//!
//! Every shape is made of points, edges and triangles with a radius around them, so that one test of points with
//! triangles and edges with edges serves all: a sphere is a point, a capsule an edge, a box or a mesh its triangles. A
//! plane alone is more: the whole space behind it.
//!
//! A collider moves and deforms by its points, which go in straight lines from frame to frame.

use boucle_geometry::{Mesh, Vector};

use crate::cloth::FARTHEST;
use crate::collision::check_number;
use crate::error::{Error, Result};

/// What a collider's points are joined to.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The space behind a plane: its points are one of the plane, and one in front of it along the normal.
    Plane,
    /// A ball around one point.
    Sphere {
        /// m.
        radius: f64,
    },
    /// A ball swept along the edge between two points.
    Capsule {
        /// m.
        radius: f64,
    },
    /// Faces; open or closed, thin or not.
    Mesh(Mesh),
}

/// Something that cloth collides with.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// What messages call it.
    pub name: String,
    /// What its points are joined to.
    pub shape: Shape,
    /// Its points at the first frame (m), world space.
    pub positions: Vec<Vector>,
    /// What is kept free around it (m), beside the cloth's own thickness.
    pub thickness: f64,
    /// Coefficient of friction; that of a pair is the geometric mean of both.
    pub friction: f64,
}

/// The faces of a box: corner i is at the larger end of axis a if bit a of i is set.
const BOX_FACES: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

impl Shape {
    /// The faces of a box whose corner i is at the larger end of axis a if bit a of i is set, seen from outside.
    ///
    /// # Panics
    /// Never: the faces are good.
    #[must_use]
    pub fn cuboid() -> Self {
        Self::Mesh(Mesh::from_faces(8, &BOX_FACES).expect("the faces of a box are good"))
    }

    /// How many points it has.
    #[must_use]
    pub fn point_count(&self) -> usize {
        match self {
            Self::Sphere { .. } => 1,
            Self::Plane | Self::Capsule { .. } => 2,
            Self::Mesh(mesh) => mesh.vertex_count(),
        }
    }

    /// How far (m) it reaches around its points, edges and triangles.
    pub(crate) fn radius(&self) -> f64 {
        match self {
            Self::Sphere { radius } | Self::Capsule { radius } => *radius,
            Self::Plane | Self::Mesh(_) => 0.0,
        }
    }
}

impl Collider {
    /// Refuses a collider that cloth cannot collide with.
    ///
    /// # Errors
    /// [`Error::BadCollider`] or [`Error::OutOfDomain`] for the first thing that is not accepted.
    pub fn check(&self) -> Result<()> {
        let owner = format!("collider \"{}\"", self.name);
        check_number(&owner, "thickness (m)", self.thickness, true)?;
        check_number(&owner, "friction", self.friction, true)?;
        if let Shape::Sphere { radius } | Shape::Capsule { radius } = self.shape {
            check_number(&owner, "radius (m)", radius, false)?;
        }
        self.check_positions(&self.positions)
    }

    /// Refuses points that are too many, too few, or no places in space.
    pub(crate) fn check_positions(&self, positions: &[Vector]) -> Result<()> {
        let (given, wanted) = (positions.len(), self.shape.point_count());
        if given != wanted {
            return self.refuse(format!("{given} points are given; accepted: {wanted}"));
        }
        let is_bad = |position: &Vector| position.iter().any(|&x| !(x.abs() <= FARTHEST));
        if let Some(point) = positions.iter().position(is_bad) {
            let [x, y, z] = positions[point].into();
            return self.refuse(format!(
                "point {point} is at ({x}, {y}, {z}) m; accepted: finite, within 1e6 m of the origin"
            ));
        }
        if self.shape == Shape::Plane && !((positions[1] - positions[0]).norm() > 1e-9) {
            return self.refuse("its normal has no length; accepted: any other".to_owned());
        }
        Ok(())
    }

    fn refuse<T>(&self, reason: String) -> Result<T> {
        Err(Error::BadCollider { collider: self.name.clone(), reason })
    }
}
