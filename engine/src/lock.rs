//! Locks that outlive a panic.

use std::sync::{Mutex, MutexGuard};

/// A lock that a panic elsewhere does not take away: the data is only ever replaced whole.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}
