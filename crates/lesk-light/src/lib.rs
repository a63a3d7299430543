//! Lights in physical units: level 3 of Lesk.
//!
//! ```
//! use lesk_light::{Light, Lights, Point, Receiver};
//! use lesk_math::{Color, Vec3, vec3};
//!
//! let lamp = Point::from_flux(vec3(0.0, 0.0, 1.5), Color::splat(1100.0))?; // lm
//! let lights = Lights::new(vec![Light::Point(lamp)])?;
//! let at = Receiver::opaque(Vec3::ZERO, Vec3::Z);
//! let sample = lights.sample(&at, 0.5, [0.5, 0.5]).expect("the lamp is above the table");
//! let illuminance = sample.value.luminance() * sample.wi.z / sample.pdf;
//! assert!((illuminance - 38.9045).abs() < 1e-4); // lx
//! # Ok::<(), lesk_light::LightError>(())
//! ```
//!
//! - [`Light`]: [`Point`], [`Spot`], [`Projector`], [`Directional`], [`Area`], [`Luminaire`], [`Environment`], [`Sky`].
//! - [`CieSky`], [`HosekSky`], [`SunPosition`]: skies, and the sun by place and time.
//! - [`EmissionMap`]: a picture that multiplies the luminance of an emissive mesh.
//! - [`Lights`]: all lights of a scene; chooses one for a [`Receiver`], near and bright ones more often.
//! - [`LightTree`]: that choice; its cost grows with the logarithm of the number of lights.
//! - [`Spectrum`]: lumens of a watt, by the name of a spectrum.
//! - [`photometry`]: luminaires from IES and EULUMDAT files.
//!
//! **Values** are linear Rec.709 RGB whose luminance Y is photometric: cd, lx, cd/m². Watts become lumens before a light
//! is made.
//!
//! **For a path tracer**: [`Lights::sample`] draws a direction; add f |cos| value / pdf where nothing lies on
//! [`LightSample::shadow_ray`]; a delta light has no other way of being found. A ray that hits an emitting surface adds
//! [`Lights::emitted`], and its weight against the light's own sampling uses [`Lights::pdf_surface`]; one that leaves the
//! scene adds [`Lights::escaped`].
//!
//! It traces no ray and knows no material; there is no light through media.

mod area;
mod body;
mod bounds;
mod cie_sky;
mod directional;
mod dome;
mod emission_map;
mod environment;
mod error;
mod far;
mod groups;
mod hosek_sky;
mod light;
mod lights;
mod luminaire;
mod parts;
pub mod photometry;
mod point;
mod projector;
mod rectangle;
mod sample;
mod sky;
mod spectrum;
mod split;
mod spot;
mod sun;
mod tree;
mod triangle;

pub use area::Area;
pub use bounds::LightBounds;
pub use cie_sky::CieSky;
pub use directional::Directional;
pub use emission_map::EmissionMap;
pub use environment::{Environment, Up, rec709};
pub use error::LightError;
pub use far::FarRectangles;
pub use hosek_sky::HosekSky;
pub use light::Light;
pub use lights::{Answer, Lights};
pub use luminaire::{Luminaire, Mounting};
pub use point::Point;
pub use projector::Projector;
pub use sample::{LightSample, Receiver, Target};
pub use sky::Sky;
pub use spectrum::Spectrum;
pub use spot::Spot;
pub use sun::{Moment, SUN_DIAMETER, SunPosition};
pub use tree::{LightTree, MAX_LIGHTS};
