//! Copies between vectors and rows with AVX2, 8 vectors at a time. The compiler's own shuffles for a stride of three take
//! half as long again. AVX-512 shuffles no more at a time, since 64 bytes hold no whole number of vectors, but writes 16 values
//! at a time: its loops read 16, and a load of two recent stores waits until both are in the cache.

use super::GROUP;
use super::group::{Group, Lines};
use std::arch::x86_64::*;

/// Values in a register.
const EIGHT: usize = 8;

/// Lanes of three registers such that each lane is that of one of them: 0, 3, 6 of the first, 1, 4, 7 of the second and
/// 2, 5 of the third. Where 8 vectors stand one after the other, these are their x; one lane further their y, then their z.
#[target_feature(enable = "avx2")]
#[inline]
fn weave([a, b, c]: [__m256; 3]) -> __m256 {
    _mm256_blend_ps::<0b00100100>(_mm256_blend_ps::<0b10010010>(a, b), c)
}

/// The components x, y, z of 8 vectors.
#[target_feature(enable = "avx2")]
#[inline]
fn split8(from: &[f32; 3 * EIGHT]) -> [__m256; 3] {
    // SAFETY: there are 8 values each
    let [a, b, c] = [0, 1, 2].map(|i| unsafe { _mm256_loadu_ps(from.as_chunks::<EIGHT>().0[i].as_ptr()) });
    [
        _mm256_permutevar8x32_ps(weave([a, b, c]), _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5)),
        _mm256_permutevar8x32_ps(weave([c, a, b]), _mm256_setr_epi32(1, 4, 7, 2, 5, 0, 3, 6)),
        _mm256_permutevar8x32_ps(weave([b, c, a]), _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7)),
    ]
}

/// 8 vectors of components x, y, z.
#[target_feature(enable = "avx2")]
#[inline]
fn join8([x, y, z]: [__m256; 3]) -> [__m256; 3] {
    let x = _mm256_permutevar8x32_ps(x, _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5));
    let y = _mm256_permutevar8x32_ps(y, _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2));
    let z = _mm256_permutevar8x32_ps(z, _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7));
    [weave([x, y, z]), weave([z, x, y]), weave([y, z, x])]
}

/// Copies with AVX2. Used in loops that enable it.
pub struct Avx2;

impl Lines for Avx2 {
    #[inline(always)]
    fn split(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]) {
        // SAFETY: the loop around it has AVX2
        unsafe { split(from, rows) };
    }
    #[inline(always)]
    fn join(rows: &[Group; 3], to: &mut [f32; 3 * GROUP], past: bool) {
        // SAFETY: the loop around it has AVX2; lines are aligned
        unsafe { if past { stream_join(rows, to) } else { join(rows, to) } };
    }
    #[inline(always)]
    fn copy(from: &Group, to: &mut Group, past: bool) {
        // SAFETY: the loop around it has AVX2; lines are aligned
        if past { unsafe { stream(from, to) } } else { *to = *from }
    }
}

/// Copies with AVX-512. Used in loops that enable it.
pub struct Avx512;

impl Lines for Avx512 {
    #[inline(always)]
    fn split(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]) {
        // SAFETY: the loop around it has AVX-512
        unsafe { split_wide(from, rows) };
    }
    #[inline(always)]
    fn join(rows: &[Group; 3], to: &mut [f32; 3 * GROUP], past: bool) {
        Avx2::join(rows, to, past);
    }
    #[inline(always)]
    fn copy(from: &Group, to: &mut Group, past: bool) {
        Avx2::copy(from, to, past);
    }
}

#[target_feature(enable = "avx2")]
#[inline]
fn split(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]) {
    for (k, vectors) in from.as_chunks::<{ 3 * EIGHT }>().0.iter().enumerate() {
        for (row, values) in rows.iter_mut().zip(split8(vectors)) {
            // SAFETY: there is room for 8 values
            unsafe { _mm256_storeu_ps(row.as_chunks_mut::<EIGHT>().0[k].as_mut_ptr(), values) };
        }
    }
}

#[target_feature(enable = "avx2,avx512f,avx512dq")]
#[inline]
fn split_wide(from: &[f32; 3 * GROUP], rows: &mut [Group; 3]) {
    for (k, [low, high]) in from.as_chunks::<{ 3 * EIGHT }>().0.as_chunks::<2>().0.iter().enumerate() {
        for (row, (low, high)) in rows.iter_mut().zip(split8(low).into_iter().zip(split8(high))) {
            let both = _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high);
            // SAFETY: there is room for 16 values
            unsafe { _mm512_storeu_ps(row.as_chunks_mut::<{ 2 * EIGHT }>().0[k].as_mut_ptr(), both) };
        }
    }
}

macro_rules! join {
    ($name:ident, $store:ident) => {
        /// # Safety
        /// A store past the caches needs an aligned target.
        #[target_feature(enable = "avx2")]
        #[inline]
        unsafe fn $name(rows: &[Group; 3], to: &mut [f32; 3 * GROUP]) {
            for (k, vectors) in to.as_chunks_mut::<{ 3 * EIGHT }>().0.iter_mut().enumerate() {
                // SAFETY: there are 8 values
                let values = [0, 1, 2].map(|c| unsafe { _mm256_loadu_ps(rows[c].as_chunks::<EIGHT>().0[k].as_ptr()) });
                for (to, values) in vectors.as_chunks_mut::<EIGHT>().0.iter_mut().zip(join8(values)) {
                    // SAFETY: there is room for 8 values; their alignment is the caller's promise
                    unsafe { $store(to.as_mut_ptr(), values) };
                }
            }
        }
    };
}
join!(join, _mm256_storeu_ps);
join!(stream_join, _mm256_stream_ps);

/// # Safety
/// `to` starts at a border of a cache line.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn stream(from: &Group, to: &mut Group) {
    for (source, target) in from.as_chunks::<EIGHT>().0.iter().zip(to.as_chunks_mut::<EIGHT>().0) {
        // SAFETY: both hold eight values; the caller promised the alignment
        unsafe { _mm256_stream_ps(target.as_mut_ptr(), _mm256_loadu_ps(source.as_ptr())) };
    }
}
