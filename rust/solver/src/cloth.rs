//! One cloth as it is given: mesh, rest shape, springs, masses, pins. It never changes, but is another once it is torn.

use boucle_geometry::{Mesh, Vector};

use crate::collision::Collision;
use crate::contact::facing;
use crate::error::{Error, Result, bad_mesh};
use crate::fabric::{Fabric, Warp, edges};
use crate::force::{Bulk, Pressure};
use crate::law::{Spring, springs_of_mesh};
use crate::material::{PinMaterial, SpringMaterial, within_one};
use crate::tailoring::Tailoring;
use crate::tear::{Tear, pieces, spread};

/// Farthest coordinate (m) accepted: beyond it differences lose the precision that springs need.
pub(crate) const FARTHEST: f64 = 1e6;

/// How heavy the particles are.
#[derive(Clone, Debug, PartialEq)]
pub enum Mass {
    /// Areal density (kg/m²): each face gives its corners equal shares of its mass.
    Density(f64),
    /// The same mass (kg) for every particle (the paper).
    PerVertex(f64),
    /// A mass (kg) for each particle.
    Each(Vec<f64>),
}

/// One cloth at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloth {
    /// What messages call it.
    pub name: String,
    /// Its faces; none for a bare network of springs.
    pub mesh: Mesh,
    /// Positions (m) that it starts from, world space: its rest shape, if `tailoring` has no other.
    pub positions: Vec<Vector>,
    /// Its springs; at most one joins two particles.
    pub springs: Vec<Spring>,
    /// Mass (kg) of each particle.
    pub masses: Vec<f64>,
    /// Particles that follow their targets, or are drawn to them.
    pub pins: Vec<u32>,
    /// How firmly each of the pins is held at first, in their order: 1 hard, below 1 soft, 0 not at all; all are hard if
    /// it is empty.
    pub pin_weights: Vec<f64>,
    /// What draws soft pins to their targets.
    pub pin_material: PinMaterial,
    /// Air damping, damping law, deformation rate and limiter; the springs hold their own stiffness.
    pub material: SpringMaterial,
    /// What it is made of beside springs; nothing if `None`.
    pub fabric: Option<Fabric>,
    /// How it collides; not at all if `None`.
    pub collision: Option<Collision>,
    /// A rest shape of its own, shrink, seams.
    pub tailoring: Tailoring,
    /// What it is inflated by.
    pub pressure: Option<Pressure>,
    /// How it meets water.
    pub bulk: Bulk,
    /// When it tears; never if `None`.
    pub tear: Option<Tear>,
    /// Of each vertex of a cloth that is torn, the vertex as given that it is a piece of; empty as long as it is whole.
    pub origins: Vec<u32>,
}

/// A cloth and the number of its first particle.
pub(crate) type Placed<'a> = (&'a Cloth, u32);

/// The cloths with their particles numbered one after the other.
pub(crate) fn placed(cloths: &[Cloth]) -> impl Iterator<Item = Placed<'_>> + Clone {
    cloths.iter().scan(0, |next, cloth| {
        let base = *next;
        *next += cloth.positions.len() as u32;
        Some((cloth, base))
    })
}

impl Cloth {
    /// A cloth with the springs and masses that its mesh gives it, which collides with nothing.
    ///
    /// # Errors
    /// When the mesh, a position (m), the mass or the material is not accepted.
    pub fn from_mesh(
        name: &str,
        mesh: Mesh,
        positions: Vec<Vector>,
        mass: &Mass,
        material: SpringMaterial,
        pins: Vec<u32>,
    ) -> Result<Self> {
        let refuse = |reason| Err(Error::BadCloth { cloth: name.to_owned(), reason });
        if positions.len() != mesh.vertex_count() {
            let (got, wanted) = (positions.len(), mesh.vertex_count());
            return refuse(format!("{got} positions are given; accepted: {wanted}, one a vertex"));
        }
        check_positions(name, &positions)?;
        if let Some(vertex) = mesh.loose_vertices().first() {
            return refuse(format!(
                "vertex {vertex} belongs to no face; accepted: meshes without loose vertices"
            ));
        }
        let masses = masses_of(name, &mesh, &positions, mass)?;
        let springs = springs_of_mesh(&mesh, &positions, &material);
        let cloth = Self {
            name: name.to_owned(),
            mesh,
            positions,
            springs,
            masses,
            pins,
            pin_weights: Vec::new(),
            pin_material: PinMaterial::default(),
            material,
            fabric: None,
            collision: None,
            tailoring: Tailoring::default(),
            pressure: None,
            bulk: Bulk::default(),
            tear: None,
            origins: Vec::new(),
        };
        cloth.check()?;
        Ok(cloth)
    }

    /// The same cloth, of fabric in the place of springs. Of the material, air damping, deformation rate and limiter hold.
    ///
    /// # Errors
    /// When the fabric is not accepted.
    pub fn of_fabric(self, fabric: Fabric) -> Result<Self> {
        fabric.check()?;
        if let Warp::Mapped(map) = &fabric.warp {
            let (got, wanted) = (map.len(), self.mesh.faces().map(<[u32]>::len).sum::<usize>());
            if got != wanted {
                let accepted = format!("{wanted}, one a corner of a face");
                return self.refuse(format!("its map has {got} places; accepted: {accepted}"));
            }
        }
        for (number, [a, b, c]) in self.mesh.triangles().enumerate() {
            let [a, b, c] = [a, b, c].map(|corner| self.positions[corner as usize]);
            if !((b - a).cross(&(c - a)).norm() > 1e-18) {
                let reason = format!(
                    "triangle {number} of its faces has no area; accepted: faces that fan out"
                );
                return self.refuse(reason);
            }
        }
        let springs = edges(&self.mesh, &self.positions);
        Ok(Self { springs, fabric: Some(fabric), ..self })
    }

    /// The vertex as given that a present one is a piece of; none beyond the last.
    pub(crate) fn as_given(&self, vertex: u32) -> Option<u32> {
        if self.origins.is_empty() {
            return ((vertex as usize) < self.positions.len()).then_some(vertex);
        }
        self.origins.get(vertex as usize).copied()
    }

    /// What is given for each vertex as given, for each present one.
    pub(crate) fn over_pieces<T: Clone>(&self, values: &[T]) -> Vec<T> {
        if self.origins.is_empty() { values.to_vec() } else { spread(&self.origins, values) }
    }

    /// The present vertices, in order, that some vertices as given are or have become.
    pub(crate) fn pieces_of(&self, vertices: &[u32]) -> Vec<u32> {
        if self.origins.is_empty() { vertices.to_vec() } else { pieces(&self.origins, vertices) }
    }

    /// Area (m²) of its faces at rest.
    pub(crate) fn area(&self) -> f64 {
        let faces = 0..self.mesh.faces().count();
        faces.map(|face| self.mesh.vector_area(face, self.rest()).norm()).sum()
    }

    /// Area (m²) at rest of each vertex: equal shares of its faces.
    pub(crate) fn vertex_areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.positions.len()];
        for (face, corners) in self.mesh.faces().enumerate() {
            let share = self.mesh.vector_area(face, self.rest()).norm() / corners.len() as f64;
            for &corner in corners {
                areas[corner as usize] += share;
            }
        }
        areas
    }

    /// Refuses a cloth that cannot be simulated.
    ///
    /// # Errors
    /// [`Error::BadCloth`] or [`Error::OutOfDomain`] for the first thing that is not accepted.
    pub fn check(&self) -> Result<()> {
        self.material.check()?;
        check_positions(&self.name, &self.positions)?;
        self.check_springs()?;
        self.fabric.as_ref().map_or(Ok(()), Fabric::check)?;
        self.check_tailoring()?;
        if let Some(pressure) = &self.pressure {
            pressure.check(&self.name, self.positions.len())?;
        }
        self.bulk.check(&self.name)?;
        self.tear.as_ref().map_or(Ok(()), |tear| tear.check(self))?;
        if self.bulk.is_hull == Some(true) && facing(&self.mesh, self.rest()) == 0.0 {
            let reason =
                "hull is true, but its mesh has a border; accepted: a closed mesh, or false";
            return self.refuse(reason.to_owned());
        }
        let count = self.positions.len();
        if self.masses.len() != count {
            let given = self.masses.len();
            return self.refuse(format!("{given} masses are given; accepted: {count}"));
        }
        let in_domain = |mass: f64| (1e-12..=1e9).contains(&mass);
        if let Some(vertex) = (0..count).find(|&vertex| !in_domain(self.masses[vertex])) {
            let mass = self.masses[vertex];
            return self.refuse(format!(
                "vertex {vertex} has a mass of {mass} kg; accepted: 1e-12 to 1e9"
            ));
        }
        self.check_pins()
    }

    fn check_pins(&self) -> Result<()> {
        let count = self.positions.len();
        if let Some(pin) = self.pins.iter().find(|&&pin| pin as usize >= count) {
            return self.refuse(format!("pin {pin} is no vertex; accepted: 0 to {}", count - 1));
        }
        let (given, wanted) = (self.pin_weights.len(), self.pins.len());
        if given != 0 && given != wanted {
            return self.refuse(format!("{given} weights of pins are given; accepted: {wanted}"));
        }
        for (pin, &weight) in self.pins.iter().zip(&self.pin_weights) {
            within_one(&format!("the weight of pin {pin}"), weight)?;
        }
        self.pin_material.check()
    }

    fn check_springs(&self) -> Result<()> {
        let count = self.positions.len();
        for spring in &self.springs {
            let [a, b] = spring.ends;
            if a == b || a.max(b) as usize >= count {
                return self.refuse(format!(
                    "a spring joins vertices {a} and {b}; accepted: two of the {count} vertices"
                ));
            }
            if !(spring.rest_length >= 1e-9) {
                return self.refuse(format!(
                    "vertices {a} and {b} are {} m apart; accepted: at least 1e-9 m (merge them, or \
                     move one)",
                    spring.rest_length
                ));
            }
            let is_positive = |value: f64| (0.0..=1e12).contains(&value);
            if !is_positive(spring.stiffness) || !is_positive(spring.damping) {
                return self.refuse(format!(
                    "the spring of vertices {a} and {b} has stiffness {} N/m and damping {} N·s/m; \
                     accepted: 0 to 1e12",
                    spring.stiffness, spring.damping
                ));
            }
        }
        Ok(())
    }

    fn refuse<T>(&self, reason: String) -> Result<T> {
        Err(Error::BadCloth { cloth: self.name.clone(), reason })
    }
}

pub(crate) fn check_positions(name: &str, positions: &[Vector]) -> Result<()> {
    let refuse = |reason| Err(Error::BadCloth { cloth: name.to_owned(), reason });
    if positions.is_empty() {
        return refuse("it has no vertices; accepted: a mesh with at least one face".to_owned());
    }
    let is_bad = |position: &Vector| position.iter().any(|&x| !(x.abs() <= FARTHEST));
    match positions.iter().position(is_bad) {
        Some(vertex) => {
            let [x, y, z] = positions[vertex].into();
            refuse(format!(
                "vertex {vertex} is at ({x}, {y}, {z}) m; accepted: finite, within 1e6 m of the origin"
            ))
        }
        None => Ok(()),
    }
}

fn masses_of(name: &str, mesh: &Mesh, positions: &[Vector], mass: &Mass) -> Result<Vec<f64>> {
    let domain = "above 0, at most 1e9";
    let out_of_domain = |quantity: &str, value| {
        let quantity = format!("cloth \"{name}\": {quantity}");
        Err(Error::OutOfDomain { quantity, value, domain })
    };
    match *mass {
        Mass::Density(density) if !(density > 0.0 && density <= 1e9) => {
            out_of_domain("density (kg/m²)", density)
        }
        Mass::PerVertex(each) if !(each > 0.0 && each <= 1e9) => {
            out_of_domain("mass_per_vertex (kg)", each)
        }
        Mass::Density(density) => lumped_masses(name, mesh, positions, density),
        Mass::PerVertex(each) => {
            check_areas(name, mesh, positions).map(|()| vec![each; positions.len()])
        }
        Mass::Each(ref masses) => check_areas(name, mesh, positions).map(|()| masses.clone()),
    }
}

fn check_areas(name: &str, mesh: &Mesh, positions: &[Vector]) -> Result<()> {
    lumped_masses(name, mesh, positions, 1.0).map(drop)
}

fn lumped_masses(name: &str, mesh: &Mesh, positions: &[Vector], density: f64) -> Result<Vec<f64>> {
    let mut masses = vec![0.0; positions.len()];
    for (face, corners) in mesh.faces().enumerate() {
        let area = mesh.vector_area(face, positions).norm();
        if !(area > 1e-18) {
            return Err(Error::BadCloth {
                cloth: name.to_owned(),
                reason: format!("face {face} has an area of {area:e} m²; accepted: above 1e-18"),
            });
        }
        let share = density * area / corners.len() as f64;
        for &corner in corners {
            masses[corner as usize] += share;
        }
    }
    Ok(masses)
}

/// A mesh of one named cloth, or its refusal.
///
/// # Errors
/// [`Error::BadCloth`] with the mesh's own sentence.
pub fn mesh_of(
    name: &str,
    vertex_count: usize,
    face_starts: Vec<u32>,
    corners: Vec<u32>,
) -> Result<Mesh> {
    Mesh::new(vertex_count, face_starts, corners).map_err(|error| bad_mesh(name, &error))
}
