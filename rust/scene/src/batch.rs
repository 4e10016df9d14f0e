//! Many scenes in one call: what becomes of each, without files.
//!
//! ```text
//! scenes -> one a core, each with one thread   small ones: a pass over so few vertices has no work for a second thread
//!        -> one after the other, all threads   large ones, after the small: two at a time would only share the memory
//! ```
//! A scene that is refused or diverges is a row with its sentence; the others go on. Rows come in the order of the scenes, and
//! every bit of a row but its seconds is that of the scene run alone: the solver's result does not depend on threads.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use boucle_solver::Interrupter;
use serde::Serialize;

use crate::assembly::Assembly;
use crate::description::Scene;
use crate::error::{Error, Result};
use crate::report::FrameRow;
use crate::{limits, source};

/// Vertices from which on a scene gets all threads: sixteen of the solver's chunks of 2048. On two cores, sheets of 96² by BDF2
/// take 1.5 times as long one after the other as one a core, of 160² 1.4 times, of 181² 1.1 times: beyond, two at a time would
/// only need twice the memory.
pub const LARGE: usize = 32_768;

/// How often, at the least, the observer is asked whether to go on.
const PATIENCE: Duration = Duration::from_millis(100);

/// What to run.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// The scenes, each as JSON with the keys of a scene file.
    pub scenes: Vec<String>,
    /// Where the files that they name are looked for.
    pub folder: PathBuf,
    /// Worker threads; 0 takes every core.
    pub threads: usize,
}

/// How far a batch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Scenes that have ended.
    pub done: usize,
    /// All scenes.
    pub total: usize,
    /// Wall-clock time (s) since the start.
    pub seconds: f64,
}

/// How a scene of a batch ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// Its last frame is reached.
    Done,
    /// A position left the finite numbers.
    Diverged,
    /// From a frame on its settings would not stay stable.
    Unstable,
    /// It cannot be simulated as it is written.
    Refused,
    /// The observer stopped the batch before.
    Stopped,
}

/// What became of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// How it ended.
    pub ending: Ending,
    /// Why, if it is not done: one sentence.
    pub error: Option<String>,
    /// The largest stable step (s) at the first frame, as [`boucle_solver::Simulation::safe_time_step`] has it.
    pub safe_time_step: Option<f64>,
    /// Largest elongation `L/L0 - 1` of mesh edges at the end of any frame.
    pub largest_strain: Option<f64>,
    /// The certificate of the first frame.
    pub first: Option<FrameRow>,
    /// The certificate of the last good frame.
    pub last: Option<FrameRow>,
    /// Wall-clock time (s) that it took.
    pub seconds: f64,
}

impl Row {
    fn new() -> Self {
        Self {
            ending: Ending::Stopped,
            error: None,
            safe_time_step: None,
            largest_strain: None,
            first: None,
            last: None,
            seconds: 0.0,
        }
    }

    fn stop(&mut self, error: &Error) {
        self.ending = match error {
            Error::Diverged { .. } => Ending::Diverged,
            Error::Unstable { .. } => Ending::Unstable,
            Error::Interrupted { .. } => Ending::Stopped,
            _ => Ending::Refused,
        };
        self.error = Some(error.to_string());
    }
}

/// Runs every scene to its last frame. `observe` is told after each scene, and ten times a second, how far the batch is; it may
/// stop it by [`ControlFlow::Break`], within a step of the scenes under way.
///
/// # Errors
/// [`Error::Input`] when so many threads are not accepted or cannot be started.
pub fn run(
    request: &Request,
    observe: &mut (dyn FnMut(&Progress) -> ControlFlow<()> + Send),
) -> Result<Vec<Row>> {
    limits::threads(request.threads)?;
    let cores = thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads =
        if request.threads == 0 { cores.min(limits::MAX_THREADS) } else { request.threads };
    let count = request.scenes.len();
    let mut batch = Batch {
        request,
        stop: Arc::default(),
        rows: vec![Row::new(); count],
        done: 0,
        started: Instant::now(),
    };
    let workers = threads.min(count).max(1);
    let each = threads / workers;
    let large = batch.pass(&Pass::new(0..count, workers, each, LARGE), observe)?;
    batch.pass(&Pass::new(large, 1, threads, usize::MAX), observe)?;
    Ok(batch.rows)
}

/// A batch under way.
struct Batch<'a> {
    request: &'a Request,
    stop: Arc<Stop>,
    rows: Vec<Row>,
    done: usize,
    started: Instant,
}

/// Some scenes of a batch, and how they are run.
struct Pass {
    /// The scenes still to be taken, the next one last.
    scenes: Mutex<Vec<usize>>,
    workers: usize,
    /// Threads of each scene.
    threads: usize,
    /// Scenes of so many vertices are left for later.
    too_large: usize,
}

impl Pass {
    fn new(
        scenes: impl IntoIterator<Item = usize>,
        workers: usize,
        threads: usize,
        too_large: usize,
    ) -> Self {
        let mut scenes: Vec<usize> = scenes.into_iter().collect();
        scenes.reverse();
        Self { scenes: Mutex::new(scenes), workers, threads, too_large }
    }

    fn take(&self) -> Option<usize> {
        self.scenes.lock().unwrap_or_else(PoisonError::into_inner).pop()
    }
}

/// What a worker tells of a scene: its row, or that it is too large for this pass.
type Told = (usize, Option<Row>);

impl Batch<'_> {
    /// Runs the scenes of a pass, and returns those that it left for later, in their order.
    fn pass(
        &mut self,
        pass: &Pass,
        observe: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Vec<usize>> {
        let (request, stop) = (self.request, Arc::clone(&self.stop));
        let stop = stop.as_ref();
        let (sender, receiver) = channel();
        thread::scope(|scope| {
            let mut workers = Vec::with_capacity(pass.workers);
            for number in 0..pass.workers {
                let sender = sender.clone();
                let builder = thread::Builder::new().name(format!("boucle-batch-{number}"));
                let started =
                    builder.spawn_scoped(scope, move || work(request, pass, stop, &sender));
                match started {
                    Ok(worker) => workers.push(worker),
                    Err(_) if !workers.is_empty() => break,
                    Err(error) => return Err(Error::input(format!("threads: {error}"))),
                }
            }
            drop(sender);
            let large = self.listen(&receiver, observe);
            for worker in workers {
                // A fault of our own goes on where the caller can tell of it.
                worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            }
            Ok(large)
        })
    }

    /// Takes the rows that workers send, until all have ended.
    fn listen(
        &mut self,
        told: &Receiver<Told>,
        observe: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Vec<usize> {
        let mut large = Vec::new();
        loop {
            match told.recv_timeout(PATIENCE) {
                Ok((scene, Some(row))) => {
                    self.done += usize::from(row.ending != Ending::Stopped);
                    self.rows[scene] = row;
                }
                Ok((scene, None)) => large.push(scene),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let total = self.rows.len();
            let seconds = self.started.elapsed().as_secs_f64();
            let progress = Progress { done: self.done, total, seconds };
            if !self.stop.is_asked() && observe(&progress).is_break() {
                self.stop.ask();
            }
        }
        large.sort_unstable();
        large
    }
}

/// Stops every scene under way, from any thread.
#[derive(Default)]
struct Stop {
    is_asked: AtomicBool,
    /// What stops each scene under way, by its number.
    running: Mutex<Vec<(usize, Interrupter)>>,
}

impl Stop {
    fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::SeqCst)
    }

    fn ask(&self) {
        self.is_asked.store(true, Ordering::SeqCst);
        for (_, interrupter) in self.running().iter() {
            interrupter.interrupt();
        }
    }

    /// Makes a scene one of those that are stopped, or says that it need not begin.
    fn begin(&self, scene: usize, interrupter: Interrupter) -> bool {
        self.running().push((scene, interrupter));
        !self.is_asked()
    }

    fn end(&self, scene: usize) {
        self.running().retain(|(running, _)| *running != scene);
    }

    fn running(&self) -> MutexGuard<'_, Vec<(usize, Interrupter)>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Runs one scene after the other, until none is left or a stop is asked for.
fn work(request: &Request, pass: &Pass, stop: &Stop, told: &Sender<Told>) {
    while let Some(scene) = pass.take().filter(|_| !stop.is_asked()) {
        let row = run_one(request, scene, pass, stop);
        if told.send((scene, row)).is_err() {
            return;
        }
    }
}

/// The row of a scene; none if it is too large for the pass.
fn run_one(request: &Request, number: usize, pass: &Pass, stop: &Stop) -> Option<Row> {
    let started = Instant::now();
    let mut row = Row::new();
    match build(&request.scenes[number], &request.folder, pass) {
        Ok(None) => return None,
        Ok(Some((mut assembly, last))) => {
            if stop.begin(number, assembly.simulation.interrupter()) {
                advance(&mut assembly, last, &mut row);
            }
            stop.end(number);
        }
        Err(error) => row.stop(&error),
    }
    row.seconds = started.elapsed().as_secs_f64();
    Some(row)
}

/// A scene ready to run, and its last frame; none if it is too large for the pass.
fn build(text: &str, folder: &Path, pass: &Pass) -> Result<Option<(Assembly, i32)>> {
    let scene = Scene::from_json(text)?;
    let meshes = source::rest_meshes(&scene, folder)?;
    if meshes.iter().map(|rest| rest.positions.len()).sum::<usize>() >= pass.too_large {
        return Ok(None);
    }
    let colliders = source::rest_colliders(&scene, folder)?;
    let assembly = Assembly::new(&scene, meshes, colliders, pass.threads)?;
    Ok(Some((assembly, scene.scene.frames[1])))
}

/// Runs a scene to its last frame, or as far as it goes.
fn advance(assembly: &mut Assembly, last: i32, row: &mut Row) {
    let mut certificate = assembly.simulation.certificate();
    row.safe_time_step = Some(assembly.simulation.safe_time_step());
    row.first = Some(FrameRow::new(&certificate, None));
    let mut largest = certificate.max_strain;
    row.ending = Ending::Done;
    while certificate.frame < last {
        match assembly.advance() {
            Ok(next) => certificate = next,
            Err(error) => {
                row.stop(&error);
                break;
            }
        }
        largest = largest.max(certificate.max_strain);
    }
    row.largest_strain = Some(largest);
    row.last = Some(FrameRow::new(&certificate, None));
}

/// The rows as strict JSON: a list of tables.
#[must_use]
pub fn to_json(rows: &[Row]) -> String {
    // Rows hold text and numbers only, which JSON can always hold.
    serde_json::to_string(rows).unwrap_or_default()
}

#[cfg(test)]
mod tests;
