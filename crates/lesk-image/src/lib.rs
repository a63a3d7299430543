//! Film, filters, tone mapping and image files: level 2 of Lesk, pixels.
//!
//! ```
//! use lesk_image::{Film, FilmSpec, Sample, ToneMapper, tonemap};
//!
//! let mut film = Film::new(FilmSpec::new(4, 2))?;
//! for tile in film.tiles(2) {
//!     let mut pixels = film.take(tile); // a copy that one thread owns
//!     for (x, y) in tile.pixels() {
//!         pixels.add(x, y, &Sample::of([100.0, 100.0, 100.0])); // cd/m2
//!     }
//!     film.put(pixels);
//! }
//! let ev100 = tonemap::meter(&film.image()).unwrap();
//! let picture = tonemap::develop(&film.image(), ev100, ToneMapper::Srgb);
//! let bytes = lesk_image::io::png::encode(&picture, lesk_image::io::png::Depth::Eight, &[])?;
//! # assert!(bytes.len() > 60);
//! # Ok::<(), lesk_image::ImageError>(())
//! ```
//!
//! - [`film`]: per pixel sums in f64: mean, variance, AOVs, split light paths; saved and restored exactly.
//! - [`filter`]: pixel filters by importance: each sample belongs to one pixel.
//! - [`tonemap`]: metering, EV100, named tone mappers, the sRGB curve.
//! - [`falsecolor`]: a perceptually ordered map of one number.
//! - [`io`]: EXR, PNG, HDR (and reading JPEG); writing that keeps the previous file on failure.
//! - [`texture`]: bilinear lookups, wrap modes, colour or data.
//! - [`distribution`]: piecewise-constant densities in one and two dimensions, sample and pdf.
//!
//! A film and every [`Image`] of [`Transfer::Linear`] that a renderer makes hold linear Rec.709 RGB whose luminance Y is
//! cd/m². Row 0 is the top row. This crate traces nothing, knows no light and no scene file, and does not manage colour:
//! ICC profiles, gamma and chromaticity chunks of files are not applied.

mod error;
mod image;
mod planes;

pub mod distribution;
pub mod falsecolor;
pub mod film;
pub mod filter;
pub mod io;
pub mod texture;
pub mod tonemap;

pub use error::ImageError;
pub use film::{Aov, Film, FilmSpec, FilmTile, Sample, Tile};
pub use filter::PixelFilter;
pub use image::{Image, Transfer};
pub use io::atomic_write;
pub use planes::{Plane, Planes, Samples};
pub use texture::Texture;
pub use tonemap::ToneMapper;

/// Largest width and height in pixels, of films and of files.
pub const MAX_SIDE: u32 = 1 << 16;
/// Largest number of pixels of a film or file: 2^27, as 16384 x 8192.
pub const MAX_PIXELS: u64 = 1 << 27;
