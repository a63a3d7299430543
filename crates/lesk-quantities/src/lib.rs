//! Radiometry, photometry and units: what a number means.
//!
//! ```
//! use lesk_quantities::{Dimension, Quantity, Unit, source};
//!
//! let flux = Quantity::parse_as("1.1 klm", &[Dimension::LuminousFlux])?;
//! let distance = Quantity::parse_as("150 cm", &[Dimension::Length])?;
//! let intensity = source::point_intensity(flux.si());
//! let illuminance = intensity / (distance.si() * distance.si());
//! assert!((illuminance - 38.9045).abs() < 5e-5); // lx
//! assert_eq!(flux.to(Unit::parse("lm")?)?, 1100.0);
//! # Ok::<(), lesk_quantities::QuantityError>(())
//! ```
//!
//! - [`Dimension`], [`Unit`], [`Quantity`]: quantities as people write them, `1100 lm`, `5 cm`, `20 mW/cm2`.
//! - [`conversion`]: from flux to illuminance, from watts to photons, with every assumption named.
//! - [`spectrum`]: illuminants, black bodies, lines, LEDs, tables from files.
//! - [`photometry`]: K_m, V(λ), V'(λ), luminous efficacy.
//! - [`observer`]: the colour matching functions of 1931, 1964 and 2006.
//! - [`colorimetry`]: chromaticity, colour temperature, Duv, colour rendering.
//! - [`radiometry`]: the black body and photons.
//! - [`colorspace`]: XYZ, linear Rec.709 and wider RGB spaces.
//! - [`upsampling`]: smooth reflectance spectra of RGB colours.
//! - [`source`]: flux, intensity, luminance and illuminance of simple sources.
//! - [`exposure`]: EV100 and the luminances that it stands for.
//!
//! It holds numbers only: no light knows its place or shape here, and there is no spectral rendering. A watt becomes a
//! lumen only through a spectrum, so a conversion between a radiometric and a photometric unit without one is refused.

mod dimension;
mod error;
mod quantity;
mod table;

pub mod colorimetry;
pub mod colorspace;
pub mod conversion;
pub mod exposure;
pub mod observer;
pub mod photometry;
pub mod radiometry;
pub mod source;
pub mod spectrum;
pub mod units;
pub mod upsampling;

pub use dimension::{Dimension, Form, System};
pub use error::QuantityError;
pub use photometry::K_M;
pub use quantity::Quantity;
pub use spectrum::Spectrum;
pub use units::Unit;
