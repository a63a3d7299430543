//! Copies between vectors and rows with AVX2, 8 vectors at a time. The compiler's own shuffles for a stride of three take
//! half as long again. AVX-512 shuffles no more at a time, since 64 bytes hold no whole number of vectors, but writes 16 values
//! at a time: its loops read 16, and a load of two recent stores waits until both are in the cache.

use super::GROUP;
use super::group::{Group, Lines};
use std::arch::x86_64::*;

/// Values in a register.
const EIGHT: usize = 8;

/// The components x, y, z of 8 vectors (Intel, *3D Vector Normalization Using 256-Bit Intel AVX*, 2011).
#[target_feature(enable = "avx2")]
#[inline]
fn split8(from: &[f32; 3 * EIGHT]) -> [__m256; 3] {
    let quads = from.as_chunks::<4>().0;
    // SAFETY: each quad is four values
    let quad = |i: usize| unsafe { _mm_loadu_ps(quads[i].as_ptr()) };
    // the low halves hold vectors 0 to 3, the high ones 4 to 7
    let [m0, m1, m2] = [0, 1, 2].map(|i| _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(quad(i)), quad(i + 3)));
    let xy = _mm256_shuffle_ps::<0b10_01_11_10>(m1, m2);
    let yz = _mm256_shuffle_ps::<0b01_00_10_01>(m0, m1);
    [
        _mm256_shuffle_ps::<0b10_00_11_00>(m0, xy),
        _mm256_shuffle_ps::<0b11_01_10_00>(yz, xy),
        _mm256_shuffle_ps::<0b11_00_11_01>(yz, m2),
    ]
}

/// 8 vectors of components x, y, z (Intel, as above).
#[target_feature(enable = "avx2")]
#[inline]
fn join8([x, y, z]: [__m256; 3]) -> [__m256; 3] {
    let xy = _mm256_shuffle_ps::<0b10_00_10_00>(x, y);
    let yz = _mm256_shuffle_ps::<0b11_01_11_01>(y, z);
    let zx = _mm256_shuffle_ps::<0b11_01_10_00>(z, x);
    let m0 = _mm256_shuffle_ps::<0b10_00_10_00>(xy, zx);
    let m1 = _mm256_shuffle_ps::<0b11_01_10_00>(yz, xy);
    let m2 = _mm256_shuffle_ps::<0b11_01_11_01>(zx, yz);
    [
        _mm256_permute2f128_ps::<0x20>(m0, m1),
        _mm256_permute2f128_ps::<0x30>(m2, m0),
        _mm256_permute2f128_ps::<0x31>(m1, m2),
    ]
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
