//! Hints for memory that is read out of order.

/// So many faces ahead, vertices are fetched: they lie all over the memory.
pub(crate) const AHEAD: usize = 8;

/// Asks for a value that will be needed soon.
#[inline(always)]
pub(crate) fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a hint that reads nothing; SSE belongs to every x86-64
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
