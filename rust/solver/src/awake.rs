//! Keeps the threads of a pool awake while a frame is computed.
//!
//! A step is some hundred short passes over all particles. A thread that sleeps between two of them takes longer to wake
//! than a pass takes, so the others look for work without a pause, and give their core away only to other programs.

use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::{Yield, current_num_threads, current_thread_index, yield_now};

/// Looks for work before a core is offered to other programs.
const LOOKS: u32 = 16;

/// Pauses between two looks.
const PAUSES: u32 = 16;

/// Runs `work` on the present thread of a pool, and keeps up to so many others awake until it ends.
pub(crate) fn with_others_awake<R: Send>(others: usize, work: impl FnOnce() -> R + Send) -> R {
    let is_done = AtomicBool::new(false);
    let own = current_thread_index();
    rayon::in_place_scope(|scope| {
        for _ in 0..others.min(current_num_threads().saturating_sub(1)) {
            // A thread that waits inside its work must not come by a request and wait for itself. The own thread is known;
            // others take requests before work, because these were the first to be spawned.
            scope.spawn(|_| {
                if current_thread_index() != own {
                    look_for_work(&is_done);
                }
            });
        }
        let _end = End(&is_done);
        work()
    })
}

/// Lets the others go, also where work panics.
struct End<'a>(&'a AtomicBool);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

fn look_for_work(is_done: &AtomicBool) {
    let mut idle = 0;
    while !is_done.load(Ordering::Acquire) {
        if yield_now() == Some(Yield::Executed) {
            idle = 0;
            continue;
        }
        idle += 1;
        if idle % LOOKS == 0 {
            std::thread::yield_now();
        }
        for _ in 0..PAUSES {
            spin_loop();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::AssertUnwindSafe;

    use super::*;

    #[test]
    fn work_is_done_and_the_others_are_let_go_even_after_a_panic() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        let sum = |limit: u32| -> u32 {
            use rayon::prelude::*;
            with_others_awake(9, || {
                assert!(limit > 0, "nothing to add");
                (0..limit).into_par_iter().sum()
            })
        };
        for limit in [10, 1000, 20] {
            assert_eq!(pool.install(|| sum(limit)), limit * (limit - 1) / 2);
        }
        let panic = std::panic::catch_unwind(AssertUnwindSafe(|| pool.install(|| sum(0))));
        assert!(panic.is_err());
        assert_eq!(pool.install(|| sum(3)), 3);
    }
}
