//! Runs jobs on all cores and returns results in the order of the jobs, so that no result depends on the number of cores.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::sync::mpsc::{channel, Receiver, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Jobs under way for each core: one that runs, and one that waits.
const JOBS_A_CORE: usize = 2;

/// Jobs on their way, and results that wait for their turn.
pub(super) struct Line<J, R> {
    jobs: Sender<(usize, J)>,
    done: Receiver<(usize, thread::Result<R>)>,
    /// Results that came before their turn, by the index of their job.
    early: BTreeMap<usize, R>,
    given: usize,
    taken: usize,
    most: usize,
}

/// Runs `drive`, which gives jobs and takes results, while a thread on each core works. `job_bytes` is the memory of a job: at most
/// `most_bytes` of jobs are under way at once, but at least one job.
pub(super) fn on_all_cores<J: Send, R: Send, T>(
    (job_bytes, most_bytes): (usize, usize),
    work: impl Fn(J) -> R + Sync,
    drive: impl FnOnce(&mut Line<J, R>) -> T,
) -> T {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let most = (most_bytes / job_bytes.max(1)).clamp(1, JOBS_A_CORE * cores);
    let (jobs, inbox) = channel();
    let (outbox, done) = channel();
    let inbox = Mutex::new(inbox);
    thread::scope(|scope| {
        for _ in 0..cores.min(most) {
            let outbox = outbox.clone();
            scope.spawn(|| serve(&inbox, outbox, &work));
        }
        drop(outbox);
        // The line is dropped when `drive` ends, even by a panic. Threads end when no job can come.
        let mut line = Line { jobs, done, early: BTreeMap::new(), given: 0, taken: 0, most };
        drive(&mut line)
    })
}

fn serve<J, R>(
    inbox: &Mutex<Receiver<(usize, J)>>,
    outbox: Sender<(usize, thread::Result<R>)>,
    work: &impl Fn(J) -> R,
) {
    loop {
        let next = inbox.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok((place, job)) = next else { return };
        // A panic must reach the caller that waits for the result.
        let result = catch_unwind(AssertUnwindSafe(|| work(job)));
        if outbox.send((place, result)).is_err() {
            return;
        }
    }
}

impl<J, R> Line<J, R> {
    /// Gives a job.
    pub(super) fn give(&mut self, job: J) {
        // Sending fails only if no thread is left. The caller that takes results learns of it.
        let _ = self.jobs.send((self.given, job));
        self.given += 1;
    }

    /// Returns the next result in order if it is ready. Waits for it while the largest number of jobs is under way.
    pub(super) fn next_ready(&mut self) -> Option<R> {
        let full = self.given - self.taken >= self.most;
        self.next(full)
    }

    /// Returns the next result in order; none if all results are taken.
    pub(super) fn next_of_all(&mut self) -> Option<R> {
        self.next(true)
    }

    fn next(&mut self, waits: bool) -> Option<R> {
        while self.taken < self.given {
            if let Some(result) = self.early.remove(&self.taken) {
                self.taken += 1;
                return Some(result);
            }
            let (place, result) = if waits { self.done.recv().ok()? } else { self.done.try_recv().ok()? };
            self.early.insert(place, result.unwrap_or_else(|panic| resume_unwind(panic)));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Later jobs are shorter and finish first.
    fn slow_first(job: u64) -> u64 {
        let spun: u64 = (0..(200 - job) * 500).map(std::hint::black_box).sum();
        assert!(spun < u64::MAX);
        job * 3
    }

    #[test]
    fn results_come_in_the_order_of_their_jobs() {
        for most_bytes in [0, 3, 1 << 20] {
            let mut results = Vec::new();
            on_all_cores((1, most_bytes), slow_first, |line| {
                for job in 0..200 {
                    line.give(job);
                    results.extend(std::iter::from_fn(|| line.next_ready()));
                    assert!(line.given - line.taken <= line.most);
                }
                results.extend(std::iter::from_fn(|| line.next_of_all()));
            });
            assert_eq!(results, (0..200).map(|job| job * 3).collect::<Vec<_>>());
        }
    }

    #[test]
    fn an_error_of_the_driver_ends_the_threads() {
        let stopped = on_all_cores((1, 100), slow_first, |line| {
            (0..50).for_each(|job| line.give(job));
            Err::<(), _>("stopped")
        });
        assert_eq!(stopped, Err("stopped"));
    }

    #[test]
    #[should_panic(expected = "job 7")]
    fn a_panic_of_a_job_is_one_of_the_driver() {
        on_all_cores(
            (1, 100),
            |job: u64| assert!(job != 7, "job {job}"),
            |line| {
                for job in 0..20 {
                    line.give(job);
                    while line.next_ready().is_some() {}
                }
                while line.next_of_all().is_some() {}
            },
        );
    }
}
