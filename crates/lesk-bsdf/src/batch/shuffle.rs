//! Copies between vectors and rows with AVX2, 8 vectors at a time. The compiler's own shuffles for a stride of three take
//! half as long again. Also used for AVX-512, which gains nothing here: a load of 64 bytes spans no whole number of vectors.

use crate::kernels::{BLOCK, Row};
use std::arch::x86_64::*;

/// Vectors in 24 values.
const GROUP: usize = 8;

/// The components x, y, z of 8 vectors (Intel, *3D Vector Normalization Using 256-Bit Intel AVX*, 2011).
#[target_feature(enable = "avx2")]
#[inline]
fn split8(from: &[f32; 3 * GROUP]) -> [__m256; 3] {
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

/// The vectors `from`, at most a block of them, to their rows.
#[target_feature(enable = "avx2")]
pub(super) fn split3(from: &[f32], rows: &mut [Row; 3]) {
    let (groups, rest) = from.as_chunks::<{ 3 * GROUP }>();
    let mut start = 0;
    for group in groups.iter().take(BLOCK / GROUP) {
        for (row, values) in rows.iter_mut().zip(split8(group)) {
            let to: &mut [f32; GROUP] = (&mut row[start..start + GROUP]).try_into().expect("the length of a group");
            // SAFETY: there is room for 8 values
            unsafe { _mm256_storeu_ps(to.as_mut_ptr(), values) };
        }
        start += GROUP;
    }
    for (i, v) in rest.as_chunks::<3>().0.iter().enumerate() {
        for c in 0..3 {
            rows[c][start + i] = v[c];
        }
    }
}

macro_rules! join {
    ($(#[$attribute:meta])* $name:ident, $store:ident) => {
        $(#[$attribute])*
        #[target_feature(enable = "avx2")]
        pub(super) unsafe fn $name(rows: &[Row; 3], to: &mut [f32]) {
            let (groups, rest) = to.as_chunks_mut::<{ 3 * GROUP }>();
            let mut start = 0;
            for group in groups.iter_mut().take(BLOCK / GROUP) {
                let values = [0, 1, 2].map(|c| {
                    let row: &[f32; GROUP] = (&rows[c][start..start + GROUP]).try_into().expect("the length of a group");
                    // SAFETY: there are 8 values
                    unsafe { _mm256_loadu_ps(row.as_ptr()) }
                });
                for (to, values) in group.as_chunks_mut::<GROUP>().0.iter_mut().zip(join8(values)) {
                    // SAFETY: there is room for 8 values; their alignment is the caller's promise
                    unsafe { $store(to.as_mut_ptr(), values) };
                }
                start += GROUP;
            }
            for (i, v) in rest.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                for c in 0..3 {
                    v[c] = rows[c][start + i];
                }
            }
        }
    };
}
join! {
    /// Rows to vectors, at most a block of them.
    join3, _mm256_storeu_ps
}
join! {
    /// The same past the caches.
    ///
    /// # Safety
    /// `to` starts at a border of a cache line.
    stream_join3, _mm256_stream_ps
}

/// Copies past the caches.
///
/// # Safety
/// `to` is whole cache lines.
#[target_feature(enable = "avx2")]
pub(super) unsafe fn stream(from: &[f32], to: &mut [f32]) {
    for (source, target) in from.as_chunks::<GROUP>().0.iter().zip(to.as_chunks_mut::<GROUP>().0) {
        // SAFETY: both hold eight values; the caller promised the alignment
        unsafe { _mm256_stream_ps(target.as_mut_ptr(), _mm256_loadu_ps(source.as_ptr())) };
    }
}
