//! From cd/m² to a screen: metering, exposure, named tone mappers, the sRGB curve.
//!
//! A picture is exposed first: 1 is the luminance that saturates the sensor, 1.2 · 2^EV100 cd/m² (see
//! [`lesk_quantities::exposure`]). A [`ToneMapper`] then maps 0..∞ to the screen's 0..1, and the result is sRGB-encoded.

use crate::ImageError;
use crate::image::{Image, Transfer, rgb_of};
use lesk_quantities::exposure;
use std::fmt;
use std::str::FromStr;

/// How exposed light becomes what a screen shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMapper {
    /// Clips at 1 and keeps every colour below as it is.
    #[default]
    Srgb,
    /// x / (1 + x) per channel: Reinhard et al., *Photographic Tone Reproduction*, SIGGRAPH 2002, Eq. 3.
    Reinhard,
    /// The filmic curve of Uncharted 2: Hable, *Uncharted 2: HDR Lighting*, GDC 2010; white at 11.2.
    Hable,
    /// Stephen Hill's fit of the ACES RRT and sRGB ODT (BakingLab, 2016), without an exposure of its own.
    Aces,
    /// Troy Sobotka's AgX, base look, with Benjamin Wrensch's polynomial of the curve (2023) in Rec.2020 as Blender 4.
    Agx,
    /// Khronos PBR Neutral (2024): true colours below 0.8, highlights compressed and desaturated above.
    Neutral,
}

impl ToneMapper {
    /// All tone mappers, the default first.
    pub const ALL: [ToneMapper; 6] = [Self::Srgb, Self::Reinhard, Self::Hable, Self::Aces, Self::Agx, Self::Neutral];

    /// Its name in commands and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Reinhard => "reinhard",
            Self::Hable => "hable",
            Self::Aces => "aces",
            Self::Agx => "agx",
            Self::Neutral => "neutral",
        }
    }

    /// Exposed linear Rec.709 to linear Rec.709 of the screen, 0 to 1. NaN and negative channels count as 0.
    pub fn map(self, exposed: [f32; 3]) -> [f32; 3] {
        // a finite bound keeps the quotients below finite
        let rgb = exposed.map(|v| if v > 0.0 { v.min(1e9) } else { 0.0 });
        let mapped = match self {
            Self::Srgb => rgb,
            Self::Reinhard => rgb.map(|v| v / (1.0 + v)),
            Self::Hable => rgb.map(|v| hable(2.0 * v) / hable(11.2)),
            Self::Aces => aces(rgb),
            Self::Agx => agx(rgb),
            Self::Neutral => neutral(rgb),
        };
        mapped.map(|v| v.clamp(0.0, 1.0))
    }
}

impl fmt::Display for ToneMapper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for ToneMapper {
    type Err = ImageError;
    fn from_str(name: &str) -> Result<ToneMapper, ImageError> {
        Self::ALL.into_iter().find(|mapper| mapper.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            ImageError::invalid(format!("tone mapper `{name}`, but one of {names} is accepted"))
        })
    }
}

/// The log-average luminance of a linear picture, cd/m²; pixels that are black or not finite do not count.
/// `None` where no pixel counts.
pub fn log_average_luminance(image: &Image) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0u64);
    for [r, g, b] in image.rgb_pixels() {
        let y = lesk_quantities::colorspace::luminance([r.into(), g.into(), b.into()]);
        if y > 0.0 && y.is_finite() {
            sum += y.ln();
            count += 1;
        }
    }
    (count > 0).then(|| (sum / count as f64).exp())
}

/// The EV100 that a reflected-light meter with K = 12.5 reads for the log-average luminance of a linear picture.
/// `None` for a black picture.
pub fn meter(image: &Image) -> Option<f64> {
    log_average_luminance(image).map(exposure::ev100_of_luminance)
}

/// A picture for a screen: exposed at `ev100`, tone mapped, sRGB-encoded. Alpha stays as it is.
pub fn develop(linear: &Image, ev100: f64, mapper: ToneMapper) -> Image {
    let scale = exposure::scale(ev100) as f32;
    let grey = linear.channels() < 3;
    let alpha = linear.channels().is_multiple_of(2);
    let channels = if grey { 1 } else { 3 } + usize::from(alpha);
    let mut data = Vec::with_capacity(linear.data().len());
    for pixel in linear.data().chunks_exact(linear.channels()) {
        let shown = mapper.map(rgb_of(pixel).map(|v| v * scale)).map(srgb_encode);
        data.extend_from_slice(if grey { &shown[..1] } else { &shown });
        if alpha {
            data.push(pixel[channels - 1]);
        }
    }
    Image::new(linear.width(), linear.height(), channels, Transfer::Srgb, data).expect("the size of another image")
}

/// Linear light to the sRGB curve (IEC 61966-2-1); mirrored for negative numbers.
pub fn srgb_encode(linear: f32) -> f32 {
    let v = linear.abs();
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    encoded.copysign(linear)
}

/// The sRGB curve back to linear light (IEC 61966-2-1); mirrored for negative numbers.
pub fn srgb_decode(encoded: f32) -> f32 {
    let v = encoded.abs();
    let linear = if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
    linear.copysign(encoded)
}

/// Hable's curve: shoulder 0.15, linear 0.5 at angle 0.1, toe 0.2, 0.02 / 0.3.
fn hable(x: f32) -> f32 {
    let (a, b, c, d, e, f) = (0.15, 0.50, 0.10, 0.20, 0.02, 0.30);
    (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f
}

/// sRGB -> XYZ -> D65 to D60 -> AP1 -> RRT saturation.
const ACES_INPUT: [[f32; 3]; 3] =
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
/// ODT saturation -> XYZ -> D60 to D65 -> sRGB.
const ACES_OUTPUT: [[f32; 3]; 3] =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

fn aces(rgb: [f32; 3]) -> [f32; 3] {
    let fit = |v: f32| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951_0) + 0.238_081);
    transform(&ACES_OUTPUT, transform(&ACES_INPUT, rgb).map(fit))
}

/// ITU-R BT.2407.
const REC2020_FROM_REC709: [[f32; 3]; 3] =
    [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0113], [0.0164, 0.0880, 0.8956]];
const REC709_FROM_REC2020: [[f32; 3]; 3] =
    [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]];
const AGX_INSET: [[f32; 3]; 3] = [
    [0.856_627_15, 0.095_121_24, 0.048_251_606],
    [0.137_318_97, 0.761_242, 0.101_439_04],
    [0.111_898_21, 0.076_799_42, 0.811_302_4],
];
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.127_100_6, -0.110_606_64, -0.016_493_939],
    [-0.141_329_76, 1.157_823_7, -0.016_493_939],
    [-0.141_329_76, -0.110_606_64, 1.251_936_4],
];

fn agx(rgb: [f32; 3]) -> [f32; 3] {
    // log2 of 0.18 · 2^-10 and 0.18 · 2^6.5
    let (black, white) = (-12.473_93, 4.026_069);
    let log = |v: f32| ((v.max(1e-10).log2() - black) / (white - black)).clamp(0.0, 1.0);
    let curve = |x: f32| {
        let (x2, x4) = (x * x, x * x * x * x);
        15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232
    };
    let shaped = transform(&AGX_INSET, transform(&REC2020_FROM_REC709, rgb)).map(|v| curve(log(v)));
    // the curve gives display code values of gamma 2.2
    let linear = transform(&AGX_OUTSET, shaped).map(|v| v.max(0.0).powf(2.2));
    transform(&REC709_FROM_REC2020, linear)
}

/// `F90` of the specification is 0.04.
fn neutral(rgb: [f32; 3]) -> [f32; 3] {
    let (start, desaturation) = (0.8 - 0.04, 0.15);
    let low = rgb[0].min(rgb[1]).min(rgb[2]);
    let offset = if low < 0.08 { low - 6.25 * low * low } else { 0.04 };
    let rgb = rgb.map(|v| v - offset);
    let peak = rgb[0].max(rgb[1]).max(rgb[2]);
    if peak < start {
        return rgb;
    }
    let d = 1.0 - start;
    let new_peak = 1.0 - d * d / (peak + d - start);
    let g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    rgb.map(|v| v * new_peak / peak * (1.0 - g) + new_peak * g)
}

fn transform(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
#[path = "tonemap_tests.rs"]
mod tests;
