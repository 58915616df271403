//! Large pages of memory. For large lists: random accesses then wait less often for the translation of addresses. For the heap of a program
//! that runs a moment: the system hands out one large page in the time of some forty small ones, and hundreds of these are needed.
#![expect(
    unsafe_code,
    reason = "calls of the C library, see the crate's documentation"
)]

/// The size of large pages where pages have 4 KiB; elsewhere the system declines.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
const LARGE: usize = 2 << 20;

/// Smaller lists are left alone: the translations of their addresses fit into the processor's caches anyway.
const LEAST: usize = 8 << 20;

/// Asks the system to move the memory of a list to large pages, if the list is large. Only the speed of reading depends on
/// whether it does.
pub fn gather_pages<T>(list: &[T]) {
    if size_of_val(list) >= LEAST {
        advise(list.as_ptr().cast_mut().cast(), size_of_val(list));
    }
}

/// Linux 6.1 and later do so at once.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
fn advise(start: *mut std::ffi::c_void, bytes: usize) {
    use std::ffi::{c_int, c_void};
    unsafe extern "C" {
        fn madvise(start: *mut c_void, bytes: usize, advice: c_int) -> c_int;
    }
    const MADV_COLLAPSE: c_int = 25;
    let from = start.addr().next_multiple_of(LARGE);
    let to = (start.addr() + bytes) / LARGE * LARGE;
    if from < to {
        // SAFETY: the range is inside of a live allocation; the advice changes neither what is in it nor where it is.
        unsafe { madvise(start.with_addr(from), to - from, MADV_COLLAPSE) };
    }
}

#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
fn advise(_: *mut std::ffi::c_void, _: usize) {}

/// Asks for large pages for the first 64 MiB of the heap, from which the C library hands out memory to the main thread. To be called once, before the
/// program allocates much. Only speed depends on whether the system has large pages; a program has 1 to 4 MiB more (measured), and keeps
/// up to 64 MiB that it has freed.
#[cfg(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64"))]
pub fn use_large_pages() {
    use std::ffi::{c_int, c_void};
    use std::hint::black_box;
    unsafe extern "C" {
        fn madvise(start: *mut c_void, bytes: usize, advice: c_int) -> c_int;
        fn malloc(bytes: usize) -> *mut c_void;
        fn mallopt(parameter: c_int, value: c_int) -> c_int;
        fn sbrk(bytes: isize) -> *mut c_void;
    }
    const M_TRIM_THRESHOLD: c_int = -1;
    const M_TOP_PAD: c_int = -2;
    const M_MMAP_THRESHOLD: c_int = -3;
    const MADV_HUGEPAGE: c_int = 14;
    /// The heap grows by this many bytes at a time, which take no memory until they are used.
    const GROWTH: c_int = 64 << 20;
    /// Larger blocks are given memory of their own.
    const OWN_MEMORY: c_int = 32 << 20;
    /// A small block, and the bytes that the C library puts before each.
    const SMALL: usize = 4000;
    const HEADER: usize = 8;
    // SAFETY: the parameters are documented; blocks are neither used nor freed; the advice changes neither what is in the heap nor where it is.
    unsafe {
        mallopt(M_MMAP_THRESHOLD, OWN_MEMORY);
        mallopt(M_TRIM_THRESHOLD, GROWTH);
        mallopt(M_TOP_PAD, GROWTH);
        // The heap ends within a large page. A block up to the next one makes it grow; what follows is untouched, but for some bytes.
        let end = sbrk(0).addr();
        let from = (end + 1).next_multiple_of(LARGE);
        let used = black_box(malloc(SMALL)).addr() + SMALL + HEADER;
        black_box(malloc((from - SMALL).saturating_sub(used)));
        let top = sbrk(0);
        let to = top.addr() / LARGE * LARGE;
        if from < to {
            madvise(top.with_addr(from), to - from, MADV_HUGEPAGE);
        }
    }
}

/// Elsewhere nothing is asked for.
#[cfg(not(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64")))]
pub fn use_large_pages() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_stay_what_they_are() {
        for count in [0, 1, 1000, 3_000_001] {
            let list: Vec<u64> = (0..count).collect();
            gather_pages(&list);
            assert!(list.iter().copied().eq(0..count));
        }
    }
    #[test]
    fn memory_works_after_large_pages_were_asked_for() {
        use_large_pages();
        for bytes in [1, 1 << 12, 5 << 20, 40 << 20] {
            let list = vec![7_u8; bytes];
            assert!(list.iter().all(|byte| *byte == 7));
        }
    }
}
