//! The class `Simulation`.

use boucle_geometry::Vector;
use boucle_scene::description::fields_from_json;
use boucle_scene::report::FrameRow;
use boucle_scene::{Assembly, Scene};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::boundary::{compute, parse_json, thread_count};
use crate::buffers;
use crate::corner_numbers;
use crate::interrupter::Interrupter;
use crate::meshes::{self, MeshArrays};
use crate::springs;

/// The bytes of a cloth's springs: ends, kinds, rest lengths, stiffnesses, dampings.
type SpringBytes<'py> = (Bytes<'py>, Bytes<'py>, Bytes<'py>, Bytes<'py>, Bytes<'py>);
type Bytes<'py> = Bound<'py, PyBytes>;

/// Cloths in motion, at the end of `frame`.
#[pyclass(module = "boucle_core")]
pub(crate) struct Simulation {
    /// `None` after a panic: nobody knows what state it left.
    pub(crate) assembly: Option<Assembly>,
}

#[pymethods]
impl Simulation {
    #[new]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's sequences are taken apart into them"
    )]
    #[pyo3(signature = (
        scene, meshes, threads = 0, colliders = Vec::new(), rests = Vec::new(), uvs = Vec::new()
    ))]
    fn new(
        py: Python<'_>,
        scene: &str,
        meshes: Vec<MeshArrays<'_>>,
        threads: i64,
        colliders: Vec<MeshArrays<'_>>,
        rests: Vec<Option<Bound<'_, PyAny>>>,
        uvs: Vec<Option<Bound<'_, PyAny>>>,
    ) -> PyResult<Self> {
        let scene = compute(py, || Scene::from_json(scene))?;
        let threads = thread_count(py, threads)?;
        let rest_meshes = meshes::of_cloths(py, &scene, &meshes, [&rests, &uvs])?;
        let colliders = meshes::of_colliders(py, &scene, &colliders)?;
        let assembly = compute(py, || Assembly::new(&scene, rest_meshes, colliders, threads))?;
        Ok(Self { assembly: Some(assembly) })
    }

    #[getter]
    fn frame(&self, py: Python<'_>) -> PyResult<i32> {
        Ok(self.assembly(py)?.simulation.frame())
    }

    #[getter]
    fn cloth_names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let simulation = &self.assembly(py)?.simulation;
        Ok((0..simulation.cloth_count())
            .map(|index| simulation.cloth(index).name.clone())
            .collect())
    }

    #[getter]
    fn collider_names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let simulation = &self.assembly(py)?.simulation;
        Ok((0..simulation.collider_count())
            .map(|index| simulation.collider(index).name.clone())
            .collect())
    }

    #[getter]
    fn safe_time_step(&mut self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |assembly| Ok(assembly.simulation.safe_time_step()))
    }

    #[getter]
    fn substeps(&mut self, py: Python<'_>) -> PyResult<u32> {
        self.with(py, |assembly| Ok(assembly.simulation.substeps()))
    }

    fn vertex_count(&self, py: Python<'_>, cloth: i64) -> PyResult<usize> {
        Ok(self.cloth(py, cloth)?.1.positions.len())
    }

    fn spring_count(&self, py: Python<'_>, cloth: i64) -> PyResult<usize> {
        let index = self.cloth(py, cloth)?.0;
        Ok(self.assembly(py)?.simulation.cloth(index).springs.len())
    }

    fn collider_point_count(&self, py: Python<'_>, collider: i64) -> PyResult<usize> {
        Ok(self.collider(py, collider)?.1.positions.len())
    }

    fn set_positions(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        positions: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, rest) = self.cloth(py, cloth)?;
        let count = rest.positions.len();
        let positions = buffers::positions(positions, "positions", Some(count))?;
        buffers::check_finite(py, &positions, 0..count, "positions")?;
        self.with(py, |assembly| {
            assembly.simulation.set_positions(index, &positions);
            Ok(())
        })
    }

    fn set_pin_targets(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        targets: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, rest) = self.cloth(py, cloth)?;
        let targets = buffers::positions(targets, "targets", Some(rest.positions.len()))?;
        let pins = rest.pins.iter().map(|&pin| pin as usize);
        buffers::check_finite(py, &targets, pins, "targets")?;
        self.with(py, |assembly| {
            assembly.simulation.set_pin_targets(index, &targets);
            Ok(())
        })
    }

    #[pyo3(signature = (cloth, shape = None, shrink = None))]
    fn set_rest(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        shape: Option<&Bound<'_, PyAny>>,
        shrink: Option<[f64; 2]>,
    ) -> PyResult<()> {
        let (index, given) = self.cloth(py, cloth)?;
        let count = given.positions.len();
        let read = |shape| buffers::positions(shape, "shape", Some(count));
        let shape = shape.map(read).transpose()?;
        self.with(py, |assembly| assembly.set_rest(index, shape.as_deref(), shrink))
    }

    #[pyo3(signature = (cloth, uniform, factor = 0.0, target_volume = None))]
    fn set_pressure(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        uniform: f64,
        factor: f64,
        target_volume: Option<f64>,
    ) -> PyResult<()> {
        let index = self.cloth(py, cloth)?.0;
        self.with(py, |assembly| {
            Ok(assembly.simulation.set_pressure(index, uniform, factor, target_volume)?)
        })
    }

    fn set_collider_targets(
        &mut self,
        py: Python<'_>,
        collider: i64,
        targets: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, rest) = self.collider(py, collider)?;
        let count = rest.positions.len();
        let targets = buffers::positions(targets, "targets", Some(count))?;
        buffers::check_finite(py, &targets, 0..count, "targets")?;
        self.with(py, |assembly| Ok(assembly.simulation.set_collider_targets(index, &targets)?))
    }

    fn set_fields(&mut self, py: Python<'_>, fields: &str) -> PyResult<()> {
        let fields = compute(py, || fields_from_json(fields))?;
        self.with(py, |assembly| Ok(assembly.simulation.set_fields(fields)?))
    }

    fn set_wind_velocity(
        &mut self,
        py: Python<'_>,
        wind: usize,
        velocity: [f64; 3],
    ) -> PyResult<()> {
        let to = Vector::from(velocity);
        self.with(py, |assembly| Ok(assembly.simulation.set_wind_velocity(wind, to)?))
    }

    fn set_water(&mut self, py: Python<'_>, level: f64, velocity: [f64; 3]) -> PyResult<()> {
        let current = Vector::from(velocity);
        self.with(py, |assembly| Ok(assembly.simulation.set_water(level, current)?))
    }

    fn set_gravity(&mut self, py: Python<'_>, gravity: [f64; 3]) -> PyResult<()> {
        self.with(py, |assembly| Ok(assembly.simulation.set_gravity(Vector::from(gravity))?))
    }

    #[pyo3(signature = (cloth, vertices = None))]
    fn release_pins(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        vertices: Option<Vec<i64>>,
    ) -> PyResult<()> {
        let (index, rest) = self.cloth(py, cloth)?;
        let vertices = match vertices {
            Some(vertices) => buffers::vertices(py, vertices, rest.positions.len())?,
            None => rest.pins.clone(),
        };
        self.with(py, |assembly| {
            assembly.simulation.release_pins(index, &vertices);
            Ok(())
        })
    }

    fn set_pin_weights(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        weights: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, rest) = self.cloth(py, cloth)?;
        let weights = buffers::numbers(weights, "weights", rest.positions.len())?;
        self.with(py, |assembly| Ok(assembly.simulation.set_pin_weights(index, &weights)?))
    }

    fn set_pin_stiffness(&mut self, py: Python<'_>, cloth: i64, stiffness: f64) -> PyResult<()> {
        let index = self.cloth(py, cloth)?.0;
        self.with(py, |assembly| Ok(assembly.simulation.set_pin_stiffness(index, stiffness)?))
    }

    fn grab(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        vertices: Vec<i64>,
        targets: &Bound<'_, PyAny>,
        weights: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, rest) = self.cloth(py, cloth)?;
        let vertices = buffers::vertices(py, vertices, rest.positions.len())?;
        let targets = buffers::positions(targets, "targets", Some(vertices.len()))?;
        let weights = buffers::numbers(weights, "weights", vertices.len())?;
        self.with(py, |assembly| {
            Ok(assembly.simulation.grab(index, &vertices, &targets, &weights)?)
        })
    }

    fn let_go(&mut self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |assembly| {
            assembly.simulation.let_go();
            Ok(())
        })
    }

    fn advance<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let row = self.with(py, |assembly| {
            let row = FrameRow::new(&assembly.advance()?, None);
            Ok(row.naming_overstretched(&assembly.simulation))
        })?;
        parse_json(py, &row.to_json())
    }

    #[pyo3(signature = (cloth = None))]
    fn certificate<'py>(
        &mut self,
        py: Python<'py>,
        cloth: Option<i64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cloths = match cloth {
            Some(cloth) => {
                let index = self.cloth(py, cloth)?.0;
                index..index + 1
            }
            None => 0..self.assembly(py)?.simulation.cloth_count(),
        };
        let row = self.with(py, |assembly| {
            let simulation = &assembly.simulation;
            let row = FrameRow::new(&simulation.certificate_of(cloths.clone()), None);
            Ok(row.naming_overstretched_of(simulation, cloths))
        })?;
        parse_json(py, &row.to_json())
    }

    fn interrupter(&self, py: Python<'_>) -> PyResult<Interrupter> {
        Ok(Interrupter(self.assembly(py)?.simulation.interrupter()))
    }

    fn read_positions(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.read_vectors(py, cloth, out, boucle_solver::Simulation::positions)
    }

    fn read_velocities(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.read_vectors(py, cloth, out, boucle_solver::Simulation::velocities)
    }

    fn read_corners(&mut self, py: Python<'_>, cloth: i64, out: &Bound<'_, PyAny>) -> PyResult<()> {
        let index = self.cloth(py, cloth)?.0;
        let rows = self.with(py, |assembly| Ok(assembly.simulation.corner_positions(index)))?;
        buffers::write_rows(out, &rows)
    }

    fn read_corner_numbers(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        quantity: &str,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (index, of) = (self.cloth(py, cloth)?.0, corner_numbers::reader(py, quantity)?);
        let numbers = self.with(py, |assembly| Ok(of(&assembly.simulation, index)))?;
        buffers::write_numbers(out, &numbers, "float32")
    }

    fn vertex_origins(&self, py: Python<'_>, cloth: i64) -> PyResult<Vec<u32>> {
        let index = self.cloth(py, cloth)?.0;
        Ok(self.assembly(py)?.simulation.origins(index))
    }

    fn torn_edges(&self, py: Python<'_>, cloth: i64) -> PyResult<Vec<(u32, u32)>> {
        let index = self.cloth(py, cloth)?.0;
        Ok(self.assembly(py)?.simulation.torn_edges(index).into_iter().map(Into::into).collect())
    }

    fn edge_tension(&mut self, py: Python<'_>, cloth: i64) -> PyResult<Vec<(u32, u32, f64)>> {
        let index = self.cloth(py, cloth)?.0;
        let edges = self.with(py, |assembly| Ok(assembly.simulation.edge_tension(index)))?;
        Ok(edges.into_iter().map(|([a, b], tension)| (a, b, tension)).collect())
    }

    fn read_strain(&mut self, py: Python<'_>, cloth: i64, out: &Bound<'_, PyAny>) -> PyResult<()> {
        self.read_numbers(py, cloth, out, boucle_solver::Simulation::vertex_strain)
    }

    fn read_tension(&mut self, py: Python<'_>, cloth: i64, out: &Bound<'_, PyAny>) -> PyResult<()> {
        self.read_numbers(py, cloth, out, boucle_solver::Simulation::vertex_tension)
    }

    fn read_wetness(&mut self, py: Python<'_>, cloth: i64, out: &Bound<'_, PyAny>) -> PyResult<()> {
        self.read_numbers(py, cloth, out, |simulation, cloth| {
            simulation.wetness(cloth).into_iter().map(|part| part as f32).collect()
        })
    }

    fn read_contacts(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.read_numbers(py, cloth, out, boucle_solver::Simulation::vertex_contacts)
    }

    fn read_intersections(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.read_numbers(py, cloth, out, boucle_solver::Simulation::vertex_intersections)
    }

    fn overstretched_edges(
        &mut self,
        py: Python<'_>,
        cloth: i64,
    ) -> PyResult<Vec<(u32, u32, f64)>> {
        let index = self.cloth(py, cloth)?.0;
        let edges = self.with(py, |assembly| Ok(assembly.simulation.overstretched_edges(index)))?;
        Ok(edges.iter().map(|edge| (edge.ends[0], edge.ends[1], edge.strain)).collect())
    }

    fn read_springs<'py>(&mut self, py: Python<'py>, cloth: i64) -> PyResult<SpringBytes<'py>> {
        let index = self.cloth(py, cloth)?.0;
        let [ends, kinds, lengths, stiffnesses, dampings] =
            self.with(py, |assembly| Ok(springs::bytes(assembly, index)))?;
        let bytes = |bytes: Vec<u8>| PyBytes::new(py, &bytes);
        Ok((bytes(ends), bytes(kinds), bytes(lengths), bytes(stiffnesses), bytes(dampings)))
    }

    fn checkpoint<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |assembly| Ok(assembly.simulation.checkpoint()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn restore(&mut self, py: Python<'_>, checkpoint: &[u8]) -> PyResult<()> {
        self.with(py, |assembly| Ok(assembly.simulation.restore(checkpoint)?))
    }
}
