//! From a scene and rest meshes to a simulation whose pins and colliders follow the scene.

use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Certificate, Cloth, Fabric, Field, Settings, Simulation, Tailoring, Warp, Water, Wind,
};

use crate::collider::{ColliderTrack, RestCollider};
use crate::description::{
    Choice, ClothDescription, FabricDescription, Grid, Model, Scene, WarpDescription,
};
use crate::error::{Error, Result};
use crate::limits;
use crate::pins::PinTrack;
use crate::shape::ShapeTrack;

/// The rest shape of a cloth.
#[derive(Clone, Debug)]
pub struct RestMesh {
    /// Its faces.
    pub mesh: Mesh,
    /// The positions (m) that it starts from, in world space.
    pub positions: Vec<Vector>,
    /// Its rest positions (m), if they are others.
    pub rest: Option<Vec<Vector>>,
    /// (u, v) of each corner of each face, as faces list them, where it has any.
    pub uvs: Option<Vec<[f64; 2]>>,
    /// The grid it was made from, by which pins may be named.
    pub grid: Option<Grid>,
}

/// A simulation, the pins that the scene moves and releases, and the colliders that it moves.
pub struct Assembly {
    /// The cloths in motion.
    pub simulation: Simulation,
    tracks: Vec<PinTrack>,
    shape_tracks: Vec<ShapeTrack>,
    collider_tracks: Vec<ColliderTrack>,
    first_frame: i32,
}

impl Assembly {
    /// Builds a simulation at the scene's first frame, at rest, from a rest mesh for each cloth and the shape of each
    /// collider. `threads` of 0 takes every core.
    ///
    /// # Errors
    /// [`Error::Input`] when the meshes, the pins or the numbers cannot be simulated.
    pub fn new(
        scene: &Scene,
        meshes: Vec<RestMesh>,
        colliders: Vec<RestCollider>,
        threads: usize,
    ) -> Result<Self> {
        limits::threads(threads)?;
        check_sizes(scene, &meshes, &colliders)?;
        let mut tracks = Vec::with_capacity(meshes.len());
        let mut cloths = Vec::with_capacity(meshes.len());
        let mut shape_tracks = Vec::with_capacity(meshes.len());
        for (description, rest) in scene.cloth.iter().zip(meshes) {
            let at = format!("cloth.{}", description.name);
            let track = PinTrack::new(&description.pins, &format!("{at}.pins"), &rest)?;
            let shape = ShapeTrack::new(description, rest.positions.len(), &at)?;
            let made = cloth(scene, description, rest, track.weighted(), &at)?;
            let shrink = shape.shrink(scene.scene.frames[0]);
            cloths.push(Cloth { tailoring: Tailoring { shrink, ..made.tailoring }, ..made });
            tracks.push(track);
            shape_tracks.push(shape);
        }
        let first_frame = scene.scene.frames[0];
        let (colliders, collider_tracks) = scene
            .collider
            .iter()
            .zip(colliders)
            .map(|(description, rest)| ColliderTrack::new(description, rest, first_frame))
            .unzip();
        let Forces { winds, fields, water } = Forces::new(scene)?;
        let mut simulation = Simulation::with_colliders(
            cloths,
            colliders,
            winds,
            Settings { water, ..settings(scene, threads) },
        )
        .map_err(solver)?;
        simulation.set_fields(fields).map_err(solver)?;
        for (index, description) in scene.cloth.iter().enumerate() {
            let velocity = Vector::from(description.velocity);
            if velocity.norm_squared() > 0.0 {
                let count = simulation.cloth(index).positions.len();
                simulation.set_velocities(index, &vec![velocity; count]);
            }
        }
        Ok(Self { simulation, tracks, shape_tracks, collider_tracks, first_frame })
    }

    /// Moves on by one frame, pins and colliders included.
    ///
    /// # Errors
    /// [`Error::Diverged`] or [`Error::Unstable`]; the state is then that of the last good frame.
    pub fn advance(&mut self) -> Result<Certificate> {
        let frame = self.simulation.frame();
        for (cloth, track) in self.tracks.iter().enumerate() {
            track.prepare(&mut self.simulation, cloth, frame, self.first_frame);
        }
        let ready = self.shape(frame).and_then(|()| self.aim_colliders(frame));
        let outcome = ready.and_then(|()| self.simulation.advance());
        outcome.map_err(|error| match solver(error) {
            Error::Input(reason) => Error::Unstable { frame: frame + 1, reason },
            other => other,
        })
    }

    /// Sets the rest shape (m, world space) of a cloth at the end of the next frame, its own if `None`, with its shrink at
    /// vertices of weight 0 and 1, that of its first frame if `None`. Keyframes of the scene come before it.
    ///
    /// # Errors
    /// [`Error::Input`] when the shape is not of the cloth's vertices, or the shrink is out of its domain.
    pub fn set_rest(
        &mut self,
        cloth: usize,
        shape: Option<&[Vector]>,
        shrink: Option<[f64; 2]>,
    ) -> Result<()> {
        let Self { simulation, shape_tracks, .. } = self;
        Ok(shape_tracks[cloth].set_rest(simulation, cloth, shape, shrink)?)
    }

    /// Sets what keyframes change of the cloths' shape on the way from `frame`.
    fn shape(&mut self, frame: i32) -> boucle_solver::Result<()> {
        for (cloth, track) in self.shape_tracks.iter().enumerate() {
            track.prepare(&mut self.simulation, cloth, frame + 1)?;
        }
        Ok(())
    }

    /// Sets where the colliders that the scene moves are to be after `frame`.
    fn aim_colliders(&mut self, frame: i32) -> boucle_solver::Result<()> {
        for (collider, track) in self.collider_tracks.iter().enumerate() {
            if let Some(targets) = track.at(frame + 1) {
                self.simulation.set_collider_targets(collider, &targets)?;
            }
        }
        Ok(())
    }
}

/// Refuses other numbers of meshes and colliders than the scene has, and cloth for which there is no memory.
fn check_sizes(scene: &Scene, meshes: &[RestMesh], colliders: &[RestCollider]) -> Result<()> {
    let (cloth_count, collider_count) = (scene.cloth.len(), scene.collider.len());
    if meshes.len() != cloth_count {
        return Err(Error::refuse("meshes", meshes.len(), &format!("{cloth_count}")));
    }
    if colliders.len() != collider_count {
        return Err(Error::refuse("colliders", colliders.len(), &format!("{collider_count}")));
    }
    let mut counts = [0; 2];
    for (description, rest) in scene.cloth.iter().zip(meshes) {
        counts[usize::from(description.model == Model::Fabric)] += rest.positions.len() as u64;
    }
    limits::memory(counts)
}

/// The `[[force]]` of a scene, by what the solver calls them.
struct Forces {
    winds: Vec<Wind>,
    fields: Vec<Field>,
    water: Option<Water>,
}

impl Forces {
    fn new(scene: &Scene) -> Result<Self> {
        let names: Vec<&str> = scene.cloth.iter().map(|cloth| cloth.name.as_str()).collect();
        let mut forces = Self { winds: Vec::new(), fields: Vec::new(), water: None };
        for (index, force) in scene.force.iter().enumerate() {
            let at = format!("force.{index}");
            forces.winds.extend(force.wind(&at, &names)?);
            forces.fields.extend(force.field(&at)?);
            forces.water = forces.water.or(force.water(&at)?);
        }
        Ok(forces)
    }
}

/// The word by which scenes and reports call an integrator.
#[must_use]
pub fn integrator_word(scene: &Scene) -> &'static str {
    scene.solver.integrator.word()
}

/// A flat sheet in a symmetric scene buckles all the same: see [`Settings::perturbation`].
const PERTURBATION: f64 = 1e-6;

fn settings(scene: &Scene, threads: usize) -> Settings {
    Settings {
        gravity: Vector::from(scene.scene.gravity),
        fps: scene.scene.fps,
        first_frame: scene.scene.frames[0],
        integrator: scene.solver.integrator,
        step_size: scene.solver.step_size(),
        tolerance: scene.solver.tolerance.unwrap_or(Settings::default().tolerance),
        linear_solver: scene.solver.linear_solver,
        perturbation: PERTURBATION,
        allow_unstable: scene.solver.allow_unstable,
        threads,
        ..Settings::default()
    }
}

fn cloth(
    scene: &Scene,
    description: &ClothDescription,
    rest: RestMesh,
    (pins, pin_weights): (Vec<u32>, Vec<f64>),
    at: &str,
) -> Result<Cloth> {
    let colliders: Vec<&str> =
        scene.collider.iter().map(|collider| collider.name.as_str()).collect();
    let cloths: Vec<&str> = scene.cloth.iter().map(|cloth| cloth.name.as_str()).collect();
    let collision = description.collision.collision(
        &scene.collision,
        description.named_fabric(),
        [&colliders, &cloths],
        rest.positions.len(),
        &format!("{at}.collision"),
    )?;
    let cloth = plain_cloth(description, rest, pins, at)?;
    let pressure = description.pressure.as_ref();
    let pressure = pressure.map(|pressure| pressure.pressure(scene.scene.frames[0]));
    let (pin_material, bulk) = (description.pin_material(), description.water.bulk());
    let vertices = cloth.positions.len();
    let tear = description.tear.tear(
        &scene.tear,
        description.named_fabric(),
        scene.scene.frames[0],
        vertices,
        &format!("{at}.tear"),
    )?;
    Ok(Cloth { collision, pin_weights, pin_material, pressure, bulk, tear, ..cloth })
}

/// A cloth of a mesh and a material, with its seams.
fn plain_cloth(
    description: &ClothDescription,
    rest: RestMesh,
    pins: Vec<u32>,
    at: &str,
) -> Result<Cloth> {
    let mass = description.mass();
    let (fabric, material) = match description.model {
        Model::Springs => {
            let shape = rest.rest.as_ref().unwrap_or(&rest.positions);
            let edge = description.springs.named().map_or(1.0, |_| mean_edge(&rest.mesh, shape));
            (None, description.springs.material(edge))
        }
        Model::Fabric => {
            let fabric = fabric(&description.fabric, rest.uvs, &format!("{at}.fabric"))?;
            (Some(fabric), description.fabric.material())
        }
    };
    let loose_edges = rest.mesh.loose_edges().to_vec();
    let (shape, start) = match rest.rest {
        Some(shape) => (shape, Some(rest.positions)),
        None => (rest.positions, None),
    };
    let made = Cloth::from_mesh(&description.name, rest.mesh, shape, &mass, material, pins)
        .and_then(|cloth| match fabric {
            Some(fabric) => cloth.of_fabric(fabric),
            None => Ok(cloth),
        })
        .and_then(|cloth| match start {
            Some(start) => cloth.starting_at(start),
            None => Ok(cloth),
        })
        .and_then(|cloth| match &description.sewing {
            Some(sewing) => cloth.sewn(sewing.sewing(&loose_edges)),
            None => Ok(cloth),
        });
    made.map_err(|error| match error {
        boucle_solver::Error::OutOfDomain { .. } => Error::input(format!("{at}.{error}")),
        other => Error::from(other),
    })
}

/// A fabric whose warp follows the UV coordinates of its mesh, if it is to.
fn fabric(description: &FabricDescription, uvs: Option<Vec<[f64; 2]>>, at: &str) -> Result<Fabric> {
    let fabric = description.fabric();
    match (description.warp, uvs) {
        (Some(WarpDescription::Uv), Some(uvs)) => Ok(Fabric { warp: Warp::Mapped(uvs), ..fabric }),
        (Some(WarpDescription::Uv), None) => Err(Error::input(format!(
            "{at}.warp = \"uv\", but its mesh has no UV coordinates; accepted: a mesh with some at \
             every corner (in OBJ files vt, and faces of v/vt), or a direction such as [0, 1, 0]"
        ))),
        _ => Ok(fabric),
    }
}

/// The mean length (m) of a mesh's edges; 1 if there are none.
fn mean_edge(mesh: &Mesh, positions: &[Vector]) -> f64 {
    let edges = mesh.edges();
    let lengths = edges.iter().filter_map(|&[a, b]| {
        Some((positions.get(a as usize)? - positions.get(b as usize)?).norm())
    });
    let mean = lengths.sum::<f64>() / edges.len() as f64;
    if mean > 0.0 { mean } else { 1.0 }
}

/// The solver's refusals of a step, told with the table they come from.
fn solver(error: boucle_solver::Error) -> Error {
    use boucle_solver::Error as Solver;
    match error {
        Solver::Unstable { .. } | Solver::TooManySubsteps { .. } => {
            Error::input(format!("solver: {error}"))
        }
        other => Error::from(other),
    }
}
