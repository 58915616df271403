//! Large pages for large lists: random accesses then wait less often for the translation of addresses.
#![expect(
    unsafe_code,
    reason = "a call of the C library, see the crate's documentation"
)]

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
    /// The size of large pages where pages have 4 KiB; elsewhere the system declines.
    const LARGE: usize = 2 << 20;
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
}
