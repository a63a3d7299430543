//! A scene that can be traced: everything looked up, checked and built.

use crate::named::named;
use crate::{Camera, Material, MeasureSettings, RasterSettings, Sensor};
use lesk_geometry::{Surface, World};
use lesk_image::PixelFilter;
use lesk_light::Lights;
use std::path::PathBuf;

/// A scene, ready for rays. Shared between threads; never changes.
#[derive(Clone, Debug)]
pub struct Scene {
    /// A line that says what it shows; may be empty.
    pub title: String,
    /// The camera.
    pub camera: Camera,
    /// The film.
    pub film: Film,
    /// How to render, unless the caller says otherwise.
    pub render: RenderSettings,
    /// How to rasterise, unless the caller says otherwise.
    pub raster: RasterSettings,
    /// Where light is measured.
    pub sensors: Vec<Sensor>,
    /// How it is measured, unless the caller says otherwise.
    pub measure: MeasureSettings,
    /// All surfaces; instance `i` is object `i`.
    pub world: World,
    /// What each instance is.
    pub objects: Vec<Object>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Lights.
    pub lights: Lights,
    /// What was repaired, converted or left out, one sentence each.
    pub notes: Vec<String>,
    /// The spectra that turned watts into lumens, by name, for the attributes of a picture.
    pub spectra: Vec<String>,
    /// The files that the scene was made of.
    pub files: Vec<PathBuf>,
    /// A hash of the description and of the bytes of all files: equal for scenes that render alike.
    pub fingerprint: [u8; 32],
}

/// One instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its name; may be empty.
    pub name: String,
    /// Index into [`Scene::materials`]; without, the surface is black.
    pub material: Option<u32>,
    /// Index into the list of [`Scene::lights`], where it shines.
    pub light: Option<u32>,
}

/// Size and filter of the film, and its exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Pixel filter.
    pub filter: PixelFilter,
    /// Exposure value at ISO 100; `None` has the picture metered.
    pub ev100: Option<f64>,
}

/// How to render, as the scene states it.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// Samples per pixel.
    pub spp: u32,
    /// Most scattering events of a path; 1 is direct light only.
    pub max_depth: u32,
    /// Scattering events after which a path may end by Russian roulette.
    pub roulette_depth: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Light-path layers: of `direct`, `indirect`, `specular`, `caustic`.
    pub split: Vec<String>,
    /// Whether the picture has albedo, normal, depth and ids.
    pub aovs: bool,
    /// Where rays to lights start on faces with interpolated normals.
    pub shadow_terminator: ShadowTerminator,
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings {
            spp: 64,
            max_depth: 16,
            roulette_depth: 3,
            seed: 0,
            split: Vec::new(),
            aovs: false,
            shadow_terminator: ShadowTerminator::default(),
        }
    }
}

/// How opaque faces with interpolated normals ask for light along the border of their own shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowTerminator {
    /// From a point raised to the surface that the faces stand for (hanika2021); the interpolated normal says which lights
    /// can be seen.
    #[default]
    Hanika,
    /// From the face; lights behind it are not seen, in whole blocks.
    None,
}

named!(ShadowTerminator, "shadow terminator", Hanika: "hanika", None: "none",);

impl Scene {
    /// The object that a ray hit.
    ///
    /// # Panics
    /// If the surface is not of this scene's world.
    #[inline]
    pub fn object(&self, surface: &Surface) -> &Object {
        &self.objects[surface.instance as usize]
    }

    /// The material that a ray hit.
    ///
    /// # Panics
    /// If the surface is not of this scene's world.
    #[inline]
    pub fn material(&self, surface: &Surface) -> Option<&Material> {
        self.object(surface).material.map(|i| &self.materials[i as usize])
    }
}
