//! The files of a bake in its folder.

use std::fs;
use std::path::{Path, PathBuf};

use super::torn::{self, CORNERS};
use crate::assembly::Assembly;
use crate::atomic::{self, Durability};
use crate::checkpoint::{self, Checkpoint};
use crate::description::{ClothDescription, Scene};
use crate::error::{Error, Result};
use crate::report::{self, Report};
use crate::{obj, pc2};

/// Longest cloth name that names a file (bytes).
const MAX_NAME: usize = 100;

/// The name of the report's file.
const REPORT: &str = "report.json";

/// A bake's folder, and the caches that are open in it, one for each cloth.
pub(super) struct Folder {
    path: PathBuf,
    caches: Vec<pc2::Writer>,
}

impl Folder {
    /// The folder, made if missing.
    pub(super) fn make(path: &Path) -> Result<Self> {
        fs::create_dir_all(path).map_err(|error| Error::cache(path, "made", &error))?;
        Ok(Self { path: path.to_owned(), caches: Vec::new() })
    }

    /// The checkpoint that a bake of this digest left, if any.
    pub(super) fn read_checkpoint(&self, digest: u128) -> Result<Option<Checkpoint>> {
        Checkpoint::read(&self.path.join(checkpoint::FILE_NAME), digest)
    }

    /// The path of the checkpoint, for messages.
    pub(super) fn checkpoint_place(&self) -> String {
        self.path.join(checkpoint::FILE_NAME).display().to_string()
    }

    /// Begins a bake: forgets the old checkpoint, writes the rest meshes, begins the caches.
    pub(super) fn start_anew(
        mut self,
        assembly: &Assembly,
        report: &Report,
        first_kept: i32,
    ) -> Result<Self> {
        forget(&self.path.join(checkpoint::FILE_NAME))?;
        self.write_report(report)?;
        let simulation = &assembly.simulation;
        for index in 0..simulation.cloth_count() {
            self.write_mesh(assembly, index)?;
            // What the end of the bake will leave, or what one has left that tore.
            forget(&if torn::tears(simulation, index) {
                self.path.join(format!("{}.pc2", simulation.given(index).name))
            } else {
                torn::corners_path(&self.path, &simulation.given(index).name)
            })?;
            let (path, point_count) = self.cache_of(assembly, index);
            self.caches.push(pc2::Writer::create(&path, point_count, first_kept)?);
        }
        Ok(self)
    }

    /// Writes the rest mesh of a cloth as it was given.
    fn write_mesh(&self, assembly: &Assembly, index: usize) -> Result<()> {
        let cloth = assembly.simulation.given(index);
        let path = self.path.join(format!("{}.obj", cloth.name));
        let mut bytes = Vec::new();
        obj::write(&mut bytes, &cloth.mesh, &cloth.positions)
            .map_err(|error| Error::cache(&path, "written", &error))?;
        atomic::replace(&path, &bytes, Durability::Process)
    }

    /// Where the cache of a cloth is, and how many points it has.
    fn cache_of(&self, assembly: &Assembly, index: usize) -> (PathBuf, u32) {
        let cloth = assembly.simulation.given(index);
        if torn::tears(&assembly.simulation, index) {
            let corners = cloth.mesh.faces().map(<[u32]>::len).sum::<usize>();
            return (torn::corners_path(&self.path, &cloth.name), corners as u32);
        }
        let path = self.path.join(format!("{}.pc2", cloth.name));
        (path, cloth.mesh.vertex_count() as u32)
    }

    /// Leaves cloth that tears as caches of the vertices that it has by now.
    pub(super) fn gather_torn(&self, assembly: &Assembly) -> Result<()> {
        let simulation = &assembly.simulation;
        let mut torn =
            (0..simulation.cloth_count()).filter(|&index| torn::tears(simulation, index));
        torn.try_for_each(|index| torn::gather(&self.path, simulation, index))
    }

    /// Takes up the caches after the samples that rows of the report tell of; what else the bake left is written anew.
    pub(super) fn take_up(
        mut self,
        assembly: &Assembly,
        first_kept: i32,
        rows: &[String],
    ) -> Result<Self> {
        let hashes: Vec<Vec<u64>> = rows.iter().map(|row| report::sample_hashes(row)).collect();
        for index in 0..assembly.simulation.cloth_count() {
            let (path, point_count) = self.cache_of(assembly, index);
            let own: Vec<u64> = hashes.iter().filter_map(|row| row.get(index).copied()).collect();
            self.caches.push(pc2::Writer::resume(&path, point_count, first_kept, &own)?);
        }
        // A cloth that tears gets its mesh in the end.
        let whole = |&index: &usize| !torn::tears(&assembly.simulation, index);
        let mut meshes = (0..self.caches.len()).filter(whole);
        meshes.try_for_each(|index| self.write_mesh(assembly, index))?;
        Ok(self)
    }

    /// Adds the positions of every cloth to its cache: of all cloths, or of none. Returns the hash of each sample.
    pub(super) fn append(&mut self, assembly: &Assembly) -> Result<Vec<u64>> {
        let samples = self.caches.first().map_or(0, pc2::Writer::sample_count) as usize;
        let mut hashes = Vec::with_capacity(self.caches.len());
        for (index, cache) in self.caches.iter_mut().enumerate() {
            let simulation = &assembly.simulation;
            let points = if torn::tears(simulation, index) {
                simulation.corner_positions(index)
            } else {
                simulation.positions(index)
            };
            match cache.append(&points) {
                Ok(hash) => hashes.push(hash),
                Err(error) => {
                    self.truncate(samples);
                    return Err(error);
                }
            }
        }
        Ok(hashes)
    }

    /// Takes samples back after a failed write. A cache that cannot even be cut keeps one sample more than the report,
    /// and is still valid.
    pub(super) fn truncate(&mut self, samples: usize) {
        for cache in &mut self.caches {
            drop(cache.truncate(samples as u32));
        }
    }

    pub(super) fn write_report(&self, report: &Report) -> Result<()> {
        report.write(&self.path.join(REPORT))
    }

    /// Writes the checkpoint, after the disk holds the caches that it goes on from.
    pub(super) fn write_checkpoint(&self, checkpoint: &Checkpoint) -> Result<()> {
        self.caches.iter().try_for_each(pc2::Writer::sync)?;
        checkpoint.write(&self.path.join(checkpoint::FILE_NAME))
    }
}

/// Removes a file, if it is there.
fn forget(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::cache(path, "removed", &error))
        }
        _ => Ok(()),
    }
}

/// Refuses to write over what is read: files of the scene, whose folder is `beside`, that a bake into another would replace.
pub(super) fn check_apart(scene: &Scene, beside: &Path, out: &Path) -> Result<()> {
    let named = scene.cloth.iter().flat_map(|cloth| {
        [".obj", ".pc2", &format!("{CORNERS}.pc2")].map(|ending| format!("{}{ending}", cloth.name))
    });
    let named = named.chain([REPORT, checkpoint::FILE_NAME].map(str::to_owned));
    let mut written: Vec<(PathBuf, String)> = named
        .filter_map(|name| fs::canonicalize(out.join(&name)).ok().map(|path| (path, name)))
        .collect();
    written.sort();
    let cloths = scene.cloth.iter().flat_map(|cloth| {
        let at = format!("cloth.{}", cloth.name);
        [(format!("{at}.mesh"), &cloth.mesh), (format!("{at}.rest"), &cloth.rest)]
    });
    let colliders = scene.collider.iter().flat_map(|collider| {
        let at = format!("collider.{}", collider.name);
        [(format!("{at}.mesh"), &collider.mesh), (format!("{at}.cache"), &collider.cache)]
    });
    for (key, file) in cloths.chain(colliders) {
        let Some(file) = file else { continue };
        let Ok(path) = fs::canonicalize(beside.join(file)) else { continue };
        if let Ok(place) = written.binary_search_by(|(own, _)| own.cmp(&path)) {
            let name = &written[place].1;
            let accepted = format!(
                "a file that the bake does not write, as it does {name:?}: bake into another folder"
            );
            return Err(Error::refuse(&key, format!("{file:?}"), &accepted));
        }
    }
    Ok(())
}

/// Refuses cloth names that cannot name a file on every system.
pub(super) fn check_names(scene: &Scene) -> Result<()> {
    for (index, cloth) in scene.cloth.iter().enumerate() {
        let name = &cloth.name;
        let is_bad = |letter: char| letter.is_control() || "/\\:*?\"<>|".contains(letter);
        let fits = name.len() <= MAX_NAME
            && !name.contains(is_bad)
            && !name.starts_with(['.', ' '])
            && !name.ends_with(['.', ' ']);
        let has_corners_of = |other: &ClothDescription| {
            name.to_lowercase() == format!("{}{CORNERS}", other.name.to_lowercase())
        };
        if let Some(other) = scene.cloth.iter().find(|other| has_corners_of(other)) {
            let accepted = format!("a name other than that of a file of cloth \"{}\"", other.name);
            let key = format!("cloth.{index}.name");
            return Err(Error::refuse(&key, format!("{name:?}"), &accepted));
        }
        if !fits {
            let accepted = "a file name of at most 100 bytes without / \\ : * ? \" < > |, and \
                            without a dot or space at either end";
            return Err(Error::refuse(
                &format!("cloth.{index}.name"),
                format!("{name:?}"),
                accepted,
            ));
        }
    }
    Ok(())
}
