//! Worker threads, which one simulation takes over from another.
//!
//! A simulation has its threads to itself as long as it lives. Then the next one takes them: each thread that begins may get an
//! arena of its own from the system's allocator, where memory stays, so that a process which simulates again and again would
//! grow.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// So many pools wait at most, before one more is made.
const MOST_IDLE: usize = 8;

struct Pool {
    /// The process that its threads belong to: a copy of a process has none of them.
    process: u32,
    /// Threads that were asked for; 0 for every core.
    count: usize,
    threads: Arc<ThreadPool>,
}

impl Pool {
    fn is_idle(&self, process: u32) -> bool {
        self.process == process && Arc::strong_count(&self.threads) == 1
    }
}

#[derive(Default)]
struct Pools(Vec<Pool>);

impl Pools {
    fn take(&mut self, count: usize) -> Result<Arc<ThreadPool>> {
        let process = std::process::id();
        let fits = |pool: &&Pool| pool.count == count && pool.is_idle(process);
        if let Some(pool) = self.0.iter().find(fits) {
            return Ok(Arc::clone(&pool.threads));
        }
        let threads = ThreadPoolBuilder::new()
            .num_threads(count)
            .thread_name(|index| format!("boucle-{index}"))
            .build()
            .map_err(|_| Error::Threads(count))?;
        let threads = Arc::new(threads);
        if self.0.iter().filter(|pool| pool.is_idle(process)).count() >= MOST_IDLE {
            self.0.retain(|pool| !pool.is_idle(process));
        }
        self.0.push(Pool { process, count, threads: Arc::clone(&threads) });
        Ok(threads)
    }
}

static POOLS: Mutex<Pools> = Mutex::new(Pools(Vec::new()));

/// So many threads that nobody else has; 0 for every core. They are free for others when the last of the result's clones goes.
///
/// # Errors
/// [`Error::Threads`] when the system gives none.
pub(crate) fn take(count: usize) -> Result<Arc<ThreadPool>> {
    POOLS.lock().unwrap_or_else(PoisonError::into_inner).take(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_taken_over_and_never_shared() {
        let mut pools = Pools::default();
        let one = pools.take(3).expect("threads");
        let other = pools.take(3).expect("threads");
        assert!(!Arc::ptr_eq(&one, &other));
        assert_eq!(one.current_num_threads(), 3);
        let clone = Arc::clone(&one);
        let address = Arc::as_ptr(&one);
        drop(one);
        let third = pools.take(3).expect("threads");
        assert!(!Arc::ptr_eq(&clone, &third), "a clone still has them");
        drop(clone);
        assert_eq!(pools.take(2).expect("threads").current_num_threads(), 2);
        assert!(std::ptr::eq(Arc::as_ptr(&pools.take(3).expect("threads")), address));
    }

    #[test]
    fn of_many_pools_few_wait() {
        let mut pools = Pools::default();
        let many: Vec<_> = (0..20).map(|_| pools.take(2).expect("threads")).collect();
        let kept = pools.take(1).expect("threads");
        assert_eq!(pools.0.len(), 21);
        drop(many);
        drop(pools.take(3).expect("threads"));
        assert_eq!(pools.0.len(), 2, "that which is used and the new one");
        drop(kept);
    }
}
