//! The headless bake: frames from a scene file into a folder, to be stopped and resumed at any frame.
//!
//! After each frame, in this order: the data of every cache, the caches' sample counts, the report, and (every two seconds
//! and at the end) the checkpoint. So the checkpoint is never ahead of what it goes on from, and a resumed bake first cuts
//! caches and report back to it. What comes out is bit-equal to a bake that never stopped: samples that are gone on from are
//! held against the hashes that the checkpoint's rows have of them, and everything else is written anew.

mod folder;
mod torn;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use boucle_solver::Certificate;
use xxhash_rust::xxh3::Xxh3;

use crate::assembly::{Assembly, RestMesh, integrator_word};
use crate::checkpoint::Checkpoint;
use crate::collider::RestCollider;
use crate::description::Scene;
use crate::error::{Error, Result};
use crate::report::{ClothRow, FrameRow, Head, Report};
use crate::{VERSION, limits, source};

use folder::Folder;

/// How often a checkpoint is written.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(2);

/// What to bake, and where to.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// The scene file.
    pub scene: PathBuf,
    /// The folder of the result, made if missing.
    pub out: PathBuf,
    /// First and last frame kept; the scene's own range if `None`.
    pub frames: Option<[i32; 2]>,
    /// Worker threads; 0 takes every core.
    pub threads: usize,
    /// `key.path=value` each.
    pub overrides: Vec<String>,
    /// Goes on from the folder's checkpoint, if there is one.
    pub resume: bool,
}

/// How far a bake is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The frame just done.
    pub frame: i32,
    /// The scene's first frame.
    pub first: i32,
    /// The last frame to do.
    pub last: i32,
    /// Wall-clock time (s) of this frame.
    pub seconds: f64,
}

/// How a bake ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every frame is there.
    Done,
    /// The observer stopped it; a resumed bake goes on.
    Stopped,
}

/// Bakes. After every frame `observe` is told how far it is, and may stop the bake by [`ControlFlow::Break`].
///
/// # Errors
/// [`Error::Input`] before anything is written; [`Error::Diverged`], [`Error::Unstable`] and [`Error::Cache`] with the
/// frames so far kept.
pub fn bake(
    request: &Request,
    observe: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<(Ending, Report)> {
    let mut bake = Bake::begin(request, Instant::now())?;
    let ending = bake.run(observe);
    // However it ended, what there is can be played.
    let gathered = bake.folder.gather_torn(&bake.assembly);
    let ending = ending?;
    gathered?;
    Ok((ending, bake.report))
}

/// A bake under way.
struct Bake {
    assembly: Assembly,
    folder: Folder,
    report: Report,
    digest: u128,
    /// The scene's first frame, and the first and the last that are kept.
    first: i32,
    first_kept: i32,
    last: i32,
    /// The first frame's certificate, where the bake starts anew.
    fresh: Option<Certificate>,
    /// When the frame under way began.
    frame_began: Instant,
    checkpoint_written: Instant,
}

impl Bake {
    fn begin(request: &Request, started: Instant) -> Result<Self> {
        let scene = source::read_scene(&request.scene, &request.overrides)?;
        let place = request.scene.display().to_string();
        let [first_kept, last] = kept_frames(&scene, request.frames)?;
        let beside = request.scene.parent().unwrap_or(Path::new("."));
        let build = || {
            folder::check_names(&scene)?;
            folder::check_apart(&scene, beside, &request.out)?;
            let meshes = source::rest_meshes(&scene, beside)?;
            let colliders = source::rest_colliders(&scene, beside)?;
            let digest = digest(&scene, &meshes, &colliders, [first_kept, last]);
            Ok((Assembly::new(&scene, meshes, colliders, request.threads)?, digest))
        };
        let (mut assembly, digest) = build().map_err(|error: Error| error.within(&place))?;
        let folder = Folder::make(&request.out)?;
        let old = if request.resume { folder.read_checkpoint(digest)? } else { None };
        let (head, first) =
            (head(&scene, &place, &assembly, request.threads), scene.scene.frames[0]);
        let (folder, report, fresh) = if let Some(old) = old {
            let restored = assembly.simulation.restore(&old.simulation);
            restored.map_err(|error| Error::from(error).within(&folder.checkpoint_place()))?;
            let folder = folder.take_up(&assembly, first_kept, &old.rows)?;
            (folder, Report::new(&head, old.rows, old.seconds), None)
        } else {
            let report = Report::new(&head, Vec::new(), 0.0);
            let folder = folder.start_anew(&assembly, &report, first_kept)?;
            (folder, report, Some(assembly.simulation.certificate()))
        };
        folder.write_report(&report)?;
        let (frame_began, checkpoint_written) = (started, started);
        Ok(Self {
            assembly,
            folder,
            report,
            digest,
            first,
            first_kept,
            last,
            fresh,
            frame_began,
            checkpoint_written,
        })
    }

    fn run(&mut self, observe: &mut dyn FnMut(&Progress) -> ControlFlow<()>) -> Result<Ending> {
        let mut certificate = self.fresh.take();
        loop {
            if let Some(certificate) = certificate {
                let progress = self.keep(&certificate)?;
                let is_last = progress.frame >= self.last;
                let wants_stop = observe(&progress).is_break();
                if is_last || wants_stop || self.checkpoint_written.elapsed() >= CHECKPOINT_EVERY {
                    self.write_checkpoint()?;
                }
                if wants_stop && !is_last {
                    return Ok(Ending::Stopped);
                }
            }
            if self.assembly.simulation.frame() >= self.last {
                return Ok(Ending::Done);
            }
            certificate = Some(self.advance()?);
        }
    }

    /// Simulates one frame. A frame that cannot be reached leaves a checkpoint of the last good one.
    fn advance(&mut self) -> Result<Certificate> {
        self.frame_began = Instant::now();
        self.assembly.advance().inspect_err(|_| {
            // What became of the cloth is what the user must hear of, even if the disk is full as well.
            drop(self.write_checkpoint());
        })
    }

    /// Writes the frame that the simulation stands at, if it is one to keep.
    fn keep(&mut self, certificate: &Certificate) -> Result<Progress> {
        let frame = certificate.frame;
        let is_kept = frame >= self.first_kept;
        let samples = if is_kept { self.folder.append(&self.assembly)? } else { Vec::new() };
        let seconds = self.frame_began.elapsed().as_secs_f64();
        self.report.spend(seconds);
        if is_kept {
            let row = FrameRow::new(certificate, Some(seconds)).with_samples(&samples);
            self.report.push(&row.naming_overstretched(&self.assembly.simulation));
            if let Err(error) = self.folder.write_report(&self.report) {
                self.report.pop();
                self.folder.truncate(self.report.rows().len());
                return Err(error);
            }
        }
        Ok(Progress { frame, first: self.first, last: self.last, seconds })
    }

    fn write_checkpoint(&mut self) -> Result<()> {
        self.folder.write_checkpoint(&Checkpoint {
            digest: self.digest,
            frame: self.assembly.simulation.frame(),
            seconds: self.report.total_seconds(),
            rows: self.report.rows().to_vec(),
            simulation: self.assembly.simulation.checkpoint(),
        })?;
        self.checkpoint_written = Instant::now();
        Ok(())
    }
}

/// The frames to keep, which must be in the scene's range.
fn kept_frames(scene: &Scene, frames: Option<[i32; 2]>) -> Result<[i32; 2]> {
    let [first, last] = scene.scene.frames;
    let Some([from, to]) = frames else { return Ok([first, last]) };
    if first <= from && from <= to && to <= last {
        return Ok([from, to]);
    }
    let accepted = format!("A:B within {first}:{last}, the first before the last");
    Err(Error::refuse("frames", format!("{from}:{to}"), &accepted))
}

/// What stands above the report's rows.
fn head<'a>(scene: &Scene, place: &'a str, assembly: &Assembly, threads: usize) -> Head<'a> {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let simulation = &assembly.simulation;
    Head {
        boucle: VERSION,
        scene: place,
        threads: if threads == 0 { cores().min(limits::MAX_THREADS) } else { threads },
        integrator: integrator_word(scene),
        hash_algorithm: "xxh3-64",
        cloths: (0..simulation.cloth_count())
            .map(|cloth| ClothRow::from(simulation.cloth(cloth)))
            .collect(),
    }
}

/// A digest of everything that the result depends on: version, scene with its overrides, meshes, colliders with their caches,
/// frames kept.
fn digest(
    scene: &Scene,
    meshes: &[RestMesh],
    colliders: &[RestCollider],
    frames: [i32; 2],
) -> u128 {
    let mut hash = Xxh3::new();
    hash.update(VERSION.as_bytes());
    // A checked scene holds only finite numbers and text, which JSON can always hold.
    hash.update(&serde_json::to_vec(scene).unwrap_or_default());
    for rest in meshes {
        hash.update(&(rest.positions.len() as u64).to_le_bytes());
        for position in rest.positions.iter().chain(rest.rest.iter().flatten()) {
            position.iter().for_each(|number| hash.update(&number.to_le_bytes()));
        }
        for face in rest.mesh.faces() {
            hash.update(&(face.len() as u64).to_le_bytes());
            for vertex in face {
                hash.update(&vertex.to_le_bytes());
            }
        }
    }
    for number in meshes.iter().flat_map(|rest| rest.uvs.iter().flatten().flatten()) {
        hash.update(&number.to_le_bytes());
    }
    for pair in meshes.iter().flat_map(|rest| rest.mesh.loose_edges()) {
        for vertex in pair {
            hash.update(&vertex.to_le_bytes());
        }
    }
    for collider in colliders {
        collider.feed(&mut hash);
    }
    hash.update(frames.map(i32::to_le_bytes).as_flattened());
    hash.digest128()
}

#[cfg(test)]
mod tests;
