//! Caches of cloth that tears.
//!
//! How often it tears is known at the end only. Until then a cache holds a point for each corner of a face, `NAME.corners.pc2`; then
//! `NAME.pc2` gets one for each vertex that the torn cloth has, of which the first are those of the cloth as it was given, and
//! `NAME.obj` the faces over them: in frames in which an edge holds, both its sides are in the same places.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use boucle_geometry::Vector;
use boucle_solver::Simulation;

use crate::atomic::{self, Durability};
use crate::error::{Error, Result};
use crate::{obj, pc2};

/// What stands between the name of a cloth and that of its cache of corners.
pub(super) const CORNERS: &str = ".corners";

/// The cache of a cloth's corners in a folder.
pub(super) fn corners_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}{CORNERS}.pc2"))
}

/// Whether a cloth tears.
pub(super) fn tears(simulation: &Simulation, cloth: usize) -> bool {
    simulation.cloth(cloth).tear.is_some()
}

/// Writes cache and mesh of a cloth as it is torn by now, from the cache of its corners.
pub(super) fn gather(folder: &Path, simulation: &Simulation, cloth: usize) -> Result<()> {
    let own = simulation.cloth(cloth);
    let mut corner_of = vec![0; own.positions.len()];
    for (corner, vertex) in simulation.corners(cloth).into_iter().enumerate().rev() {
        corner_of[vertex as usize] = corner;
    }
    let (from, path) = (corners_path(folder, &own.name), folder.join(format!("{}.pc2", own.name)));
    let part = folder.join(format!("{}.pc2.part", own.name));
    let gathered = copy(&from, &part, &corner_of).and_then(|()| {
        std::fs::rename(&part, &path).map_err(|error| Error::cache(&path, "written", &error))
    });
    gathered.inspect_err(|_| drop(std::fs::remove_file(&part)))?;
    let path = folder.join(format!("{}.obj", own.name));
    let mut bytes = Vec::new();
    obj::write(&mut bytes, &own.mesh, &own.positions)
        .map_err(|error| Error::cache(&path, "written", &error))?;
    atomic::replace(&path, &bytes, Durability::Process)
}

/// Copies those of a cache's points, sample after sample.
fn copy(from: &Path, to: &Path, points: &[usize]) -> Result<()> {
    let unreadable = |error: &std::io::Error| Error::cache(from, "read", error);
    let file = File::open(from).map_err(|error| unreadable(&error))?;
    let mut source = BufReader::new(file);
    let header = pc2::Header::read(&mut source).map_err(|error| unreadable(&error))?;
    let mut writer = pc2::Writer::create(to, points.len() as u32, header.first_frame)?;
    let mut sample = vec![0; 12 * header.vertex_count as usize];
    for _ in 0..header.sample_count {
        source.read_exact(&mut sample).map_err(|error| unreadable(&error))?;
        let numbers = sample.as_chunks::<4>().0;
        let at = |point: usize| {
            Vector::from_fn(|axis, _| f64::from(f32::from_le_bytes(numbers[3 * point + axis])))
        };
        let positions: Vec<Vector> = points.iter().map(|&point| at(point)).collect();
        writer.append(&positions)?;
    }
    writer.sync()
}
