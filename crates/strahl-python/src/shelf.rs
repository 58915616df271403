//! The memory of lists that Python has freed, for the next ones: fresh memory takes a tenth of the time of easy rays.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Lists on a shelf.
const PLACES: usize = 2;

/// The largest list that is kept, in bytes.
const LARGEST: usize = 64 << 20;

/// Lists that nobody uses.
pub(crate) struct Shelf<T>(Mutex<Vec<Vec<T>>>);

impl<T: Copy> Shelf<T> {
    pub(crate) const fn new() -> Self {
        Self(Mutex::new(vec![]))
    }

    fn lists(&self) -> MutexGuard<'_, Vec<Vec<T>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A list from the shelf that is long enough and not much too long. Its entries are old ones, or `none`.
    pub(crate) fn take(&self, count: usize, none: T) -> Option<Vec<T>> {
        let mut lists = self.lists();
        let fits = |list: &Vec<T>| (count..=count.saturating_mul(4)).contains(&list.capacity());
        let place = lists.iter().position(fits)?;
        let mut list = lists.swap_remove(place);
        drop(lists);
        list.resize(count, none);
        Some(list)
    }

    /// Keeps a list for another caller, unless it is large. The oldest one goes.
    pub(crate) fn put(&self, list: Vec<T>) {
        if list.is_empty() || list.capacity() * size_of::<T>() > LARGEST {
            return;
        }
        let mut lists = self.lists();
        lists.push(list);
        let oldest = (lists.len() > PLACES).then(|| lists.remove(0));
        drop(lists);
        drop(oldest);
    }
}
