//! A scene as people state it: names, files, quantities. [`SceneDescription::build`] looks everything up.
//!
//! ```
//! use lesk_quantities::Quantity;
//! use lesk_scene::description::*;
//!
//! let mut scene = SceneDescription::new(CameraDescription::look_at([0.0, -4.0, 1.0], [0.0, 0.0, 0.5]));
//! scene.materials.push(MaterialDescription::new("clay", "lambert").set("reflectance", &[0.4, 0.3, 0.2]));
//! scene.objects.push(ObjectDescription::new(Shape::Sphere { radius: 0.5 }).material("clay"));
//! let emission = Emission::new(Quantity::parse("1100 lm")?);
//! scene.lights.push(LightDescription::new(LightKind::Point { position: [1.0, -2.0, 3.0] }, emission));
//! let scene = scene.build()?;
//! assert_eq!(scene.objects.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera;
mod light;
mod material;
mod object;

pub use camera::{Aperture, CameraDescription, FieldOfView, View};
pub use light::{
    AreaLightDescription, Emission, EnvironmentDescription, EnvironmentKind, LightColor, LightDescription, LightKind,
    LuminaireDescription, MapStrength,
};
pub use material::{MaterialDescription, NormalMapDescription, Picture, Source, TextureDescription};
pub use object::{GroupDescription, Normals, ObjectDescription, Shape, Triangles};

use crate::scene::{Film, RenderSettings};
use crate::{MeasureSettings, RasterSettings, Sensor};
use lesk_image::PixelFilter;
use std::path::PathBuf;

/// Everything that a scene file states. Lengths are metres, angles radians.
#[derive(Clone, Debug)]
pub struct SceneDescription {
    /// A line that says what it shows; may be empty.
    pub title: String,
    /// Where the picture is taken from.
    pub camera: CameraDescription,
    /// Size and filter of the film.
    pub film: Film,
    /// How to render.
    pub render: RenderSettings,
    /// How to rasterise.
    pub raster: RasterSettings,
    /// Where light is measured.
    pub sensors: Vec<Sensor>,
    /// How it is measured.
    pub measure: MeasureSettings,
    /// Materials by name.
    pub materials: Vec<MaterialDescription>,
    /// Objects that are placed as one.
    pub groups: Vec<GroupDescription>,
    /// What is there.
    pub objects: Vec<ObjectDescription>,
    /// Lights that are no surface.
    pub lights: Vec<LightDescription>,
    /// Luminaires from photometric files.
    pub luminaires: Vec<LuminaireDescription>,
    /// What lies behind everything.
    pub environment: Option<EnvironmentDescription>,
    /// Where relative file names start.
    pub folder: PathBuf,
}

impl SceneDescription {
    /// An empty scene of 640 x 480 pixels.
    pub fn new(camera: CameraDescription) -> Self {
        SceneDescription {
            title: String::new(),
            camera,
            film: Film { width: 640, height: 480, filter: PixelFilter::default(), ev100: None },
            render: RenderSettings::default(),
            raster: RasterSettings::default(),
            sensors: Vec::new(),
            measure: MeasureSettings::default(),
            materials: Vec::new(),
            groups: Vec::new(),
            objects: Vec::new(),
            lights: Vec::new(),
            luminaires: Vec::new(),
            environment: None,
            folder: PathBuf::new(),
        }
    }
}
