//! Frames that take long are interrupted: a frame may be slow, but not deaf.

use std::sync::{Mutex, Once, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use boucle_solver::Interrupter;

/// How long a frame may take before it is asked to stop.
const PATIENCE: Duration = Duration::from_millis(500);
/// How long it may go on after that. Other programs may be busy.
const LATEST: Duration = Duration::from_secs(20);

static RUNNING: Mutex<Option<(Instant, Interrupter)>> = Mutex::new(None);
static WATCHER: Once = Once::new();
/// Those who watch at a time: one.
static TURN: Mutex<()> = Mutex::new(());

/// Does what `interrupter` stops.
///
/// # Panics
/// When it does not stop in time.
pub(crate) fn watched<T>(interrupter: Interrupter, work: impl FnOnce() -> T) -> T {
    WATCHER.call_once(|| drop(thread::spawn(watch)));
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let started = Instant::now();
    put(Some((started, interrupter)));
    let done = work();
    put(None);
    let seconds = started.elapsed();
    assert!(
        seconds < PATIENCE + LATEST,
        "a frame went on for {seconds:?} after it was interrupted"
    );
    done
}

fn put(running: Option<(Instant, Interrupter)>) {
    *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) = running;
}

fn watch() {
    loop {
        thread::sleep(PATIENCE / 10);
        let running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((started, interrupter)) = &*running
            && started.elapsed() > PATIENCE
        {
            interrupter.interrupt();
        }
    }
}
