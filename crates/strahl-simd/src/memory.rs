//! A limit on the memory of the whole program: an allocator that counts the bytes in use.
//!
//! A scene may ask for any amount of memory, by a small picture that decompresses to gigabytes or by a loop. The system then
//! kills some program. [`Bounded`] refuses the request before that, and lets the program report what it was doing.
#![expect(
    unsafe_code,
    reason = "an allocator can't be written without, see the crate's documentation"
)]

pub use crate::pages::use_large_pages;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicIsize, AtomicUsize, Ordering};

/// The number of bytes that a thread counts by itself before it updates the common counter: this takes a nanosecond, while
/// threads would contend for the common counter's cache line.
const OWN: isize = 64 << 10;

thread_local! {
    /// Bytes allocated (or freed) by this thread that the common counter does not include yet.
    static UNTOLD: Cell<isize> = const { Cell::new(0) };
    /// Whether this thread can continue if an allocation is refused.
    static CAN_DO_WITHOUT: Cell<bool> = const { Cell::new(false) };
    /// Whether this thread is ending the program, or finding out about the limit, for which it needs memory.
    static EXEMPT: Cell<bool> = const { Cell::new(false) };
}

/// A refused allocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Bytes requested.
    pub asked: usize,
    /// Bytes in use.
    pub used: usize,
    /// Bytes allowed.
    pub limit: usize,
}

/// The system's allocator with a limit. As the global allocator of a program it limits all memory except mapped files and the
/// stacks of threads.
#[derive(Debug)]
pub struct Bounded {
    used: AtomicIsize,
    limit: AtomicUsize,
    /// Whether `limit` is the number of bytes from which on [`Bounded::limit_later`]'s function is asked.
    preliminary: AtomicBool,
    find: OnceLock<fn() -> usize>,
    end: OnceLock<fn(Refusal) -> !>,
}

impl Default for Bounded {
    fn default() -> Self {
        Self::new()
    }
}

impl Bounded {
    /// An allocator without a limit.
    pub const fn new() -> Self {
        Self {
            used: AtomicIsize::new(0),
            limit: AtomicUsize::new(usize::MAX),
            preliminary: AtomicBool::new(false),
            find: OnceLock::new(),
            end: OnceLock::new(),
        }
    }

    /// Sets the limit in bytes, and the function that ends the program if an allocation is refused to a thread that can't
    /// continue without it. The function may allocate memory. Only the first function counts.
    pub fn limit(&self, bytes: usize, end: fn(Refusal) -> !) {
        // A second function is ignored, as documented.
        let _ = self.end.set(end);
        self.preliminary.store(false, Ordering::Relaxed);
        self.limit.store(bytes, Ordering::Relaxed);
    }

    /// The same with a limit that takes time to find out: `find` is asked when more than `free` bytes are in use for the first time.
    /// Both functions may allocate memory. Only the first two count.
    pub fn limit_later(&self, free: usize, find: fn() -> usize, end: fn(Refusal) -> !) {
        let _ = (self.end.set(end), self.find.set(find));
        self.limit.store(free, Ordering::Relaxed);
        self.preliminary.store(true, Ordering::Relaxed);
    }

    /// Whether bytes in use exceed the limit.
    fn exceeded(&self, used: isize) -> bool {
        let used = usize::try_from(used).unwrap_or(0);
        if used <= self.limit.load(Ordering::Relaxed) || EXEMPT.get() {
            return false;
        }
        self.exceeds_true_limit(used)
    }

    #[cold]
    fn exceeds_true_limit(&self, used: usize) -> bool {
        if self.preliminary.load(Ordering::Acquire)
            && let Some(find) = self.find.get()
        {
            EXEMPT.set(true);
            let limit = find();
            EXEMPT.set(false);
            // Several threads may come here at once, with the same result. Who sees that the limit is no longer preliminary sees it, too.
            self.limit.store(limit, Ordering::Relaxed);
            self.preliminary.store(false, Ordering::Release);
        }
        used > self.limit.load(Ordering::Relaxed)
    }

    /// Bytes in use, accurate to some ten thousand per thread.
    pub fn used(&self) -> usize {
        usize::try_from(self.used.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// Counts bytes before an allocation; returns `false`, and counts nothing, if they exceed the limit.
    fn take(&self, bytes: usize) -> bool {
        let Ok(bytes) = isize::try_from(bytes) else {
            return false;
        };
        let untold = UNTOLD.get() + bytes;
        if untold <= OWN {
            UNTOLD.set(untold);
            return true;
        }
        let used = self.used.fetch_add(untold, Ordering::Relaxed) + untold;
        if self.exceeded(used) {
            self.used.fetch_sub(untold, Ordering::Relaxed);
            return false;
        }
        UNTOLD.set(0);
        true
    }

    /// Counts freed bytes.
    fn give(&self, bytes: usize) {
        let untold = UNTOLD.get() - bytes as isize;
        if untold >= -OWN {
            UNTOLD.set(untold);
        } else {
            self.used.fetch_add(untold, Ordering::Relaxed);
            UNTOLD.set(0);
        }
    }

    /// Refuses an allocation: returns null to threads that can continue, ends the program for others.
    #[cold]
    fn refused(&self, asked: usize) -> *mut u8 {
        if !CAN_DO_WITHOUT.get()
            && let Some(end) = self.end.get()
            && !EXEMPT.replace(true)
        {
            end(Refusal {
                asked,
                // With what this thread counts by itself, so that the sum is above the limit if that is the reason.
                used: self.used().saturating_add_signed(UNTOLD.get()),
                limit: self.limit.load(Ordering::Relaxed),
            })
        }
        std::ptr::null_mut()
    }
}

// SAFETY: every request is passed to the system's allocator, which fulfils the contract, or answered with null, which the
// contract allows. Nothing in between allocates: the thread's counters have no destructors and exist from the beginning.
unsafe impl GlobalAlloc for Bounded {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !self.take(layout.size()) {
            return self.refused(layout.size());
        }
        // SAFETY: the caller's layout.
        let start = unsafe { System.alloc(layout) };
        if start.is_null() {
            self.give(layout.size());
            return self.refused(layout.size());
        }
        start
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !self.take(layout.size()) {
            return self.refused(layout.size());
        }
        // SAFETY: the caller's layout.
        let start = unsafe { System.alloc_zeroed(layout) };
        if start.is_null() {
            self.give(layout.size());
            return self.refused(layout.size());
        }
        start
    }

    unsafe fn dealloc(&self, start: *mut u8, layout: Layout) {
        self.give(layout.size());
        // SAFETY: the caller got the block from a function here, which got it from the system with this layout.
        unsafe { System.dealloc(start, layout) };
    }

    unsafe fn realloc(&self, start: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        let more = new_size.saturating_sub(layout.size());
        if !self.take(more) {
            return self.refused(more);
        }
        // SAFETY: the caller got the block from a function here, which got it from the system with this layout.
        let moved = unsafe { System.realloc(start, layout, new_size) };
        if moved.is_null() {
            self.give(more);
            return self.refused(more);
        }
        self.give(layout.size().saturating_sub(new_size));
        moved
    }
}

/// Whether this many bytes can be allocated now. Readers ask before a large allocation, so that their error can say what it was
/// for.
pub fn fits(bytes: u64) -> bool {
    let Ok(bytes) = usize::try_from(bytes) else {
        return false;
    };
    let before = CAN_DO_WITHOUT.replace(true);
    let fits = Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
    CAN_DO_WITHOUT.set(before);
    fits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(bytes: usize) -> Layout {
        Layout::from_size_align(bytes, 8).unwrap()
    }

    #[test]
    fn the_limit_counts_what_is_in_use() {
        let memory = Bounded::new();
        // No function ends this program, so a refusal is null.
        memory.limit.store(1 << 20, Ordering::Relaxed);
        // SAFETY: layouts of some bytes; each block is freed once, with its layout.
        unsafe {
            let half = memory.alloc(layout(1 << 19));
            assert!(!half.is_null());
            assert!(memory.alloc_zeroed(layout(1 << 20)).is_null());
            let more = memory.realloc(half, layout(1 << 19), 3 << 18);
            assert!(!more.is_null());
            assert!(memory.realloc(more, layout(3 << 18), 2 << 20).is_null());
            assert!(memory.used().abs_diff(3 << 18) <= OWN as usize);
            memory.dealloc(more, layout(3 << 18));
            assert!(memory.used() <= 2 * OWN as usize);
            let all = memory.alloc(layout((1 << 20) - OWN as usize));
            assert!(!all.is_null());
            memory.dealloc(all, layout((1 << 20) - OWN as usize));
        }
    }

    #[test]
    fn a_limit_is_found_out_when_it_may_matter() {
        let memory = Bounded::new();
        memory.preliminary.store(true, Ordering::Relaxed);
        memory.limit.store(1 << 19, Ordering::Relaxed);
        memory.find.set(|| 1 << 20).unwrap();
        // SAFETY: layouts of some bytes; the block is freed once, with its layout.
        unsafe {
            let little = memory.alloc(layout(1 << 18));
            assert_eq!(memory.limit.load(Ordering::Relaxed), 1 << 19);
            let more = memory.alloc(layout(1 << 19));
            assert!(!more.is_null());
            assert_eq!(memory.limit.load(Ordering::Relaxed), 1 << 20);
            assert!(memory.alloc(layout(1 << 20)).is_null());
            memory.dealloc(little, layout(1 << 18));
            memory.dealloc(more, layout(1 << 19));
        }
    }

    #[test]
    fn small_requests_are_counted_too() {
        let memory = Bounded::new();
        memory.limit.store(1 << 20, Ordering::Relaxed);
        let mut blocks = vec![];
        // SAFETY: layouts of 64 bytes; each block is freed once.
        unsafe {
            loop {
                let block = memory.alloc(layout(64));
                if block.is_null() {
                    break;
                }
                blocks.push(block);
                assert!(blocks.len() < 1 << 20, "there is no end");
            }
            for block in &blocks {
                memory.dealloc(*block, layout(64));
            }
        }
        let bytes = blocks.len() * 64;
        assert!(bytes.abs_diff(1 << 20) <= 2 * OWN as usize, "{bytes}");
    }

    #[test]
    fn more_than_there_is_does_not_fit() {
        assert!(fits(1 << 20) && !fits(u64::MAX) && !fits(1 << 62));
    }
}
