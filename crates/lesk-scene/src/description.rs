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

use crate::error::Place;
use crate::scene::{Film, RenderSettings};
use lesk_geometry::{Mesh, Transform};
use lesk_image::texture::{Channel, Interpolation, Role, Wrap};
use lesk_image::{Image, PixelFilter};
use lesk_light::{Spectrum, Up};
use lesk_quantities::Quantity;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

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
    /// Materials by name.
    pub materials: Vec<MaterialDescription>,
    /// Objects that are placed as one.
    pub groups: Vec<GroupDescription>,
    /// What is there.
    pub objects: Vec<ObjectDescription>,
    /// Lights that are no surface.
    pub lights: Vec<LightDescription>,
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
            materials: Vec::new(),
            groups: Vec::new(),
            objects: Vec::new(),
            lights: Vec::new(),
            environment: None,
            folder: PathBuf::new(),
        }
    }
}

/// A camera.
#[derive(Clone, Debug)]
pub struct CameraDescription {
    /// Where it stands.
    pub view: View,
    /// How much it sees; `None` takes 40 deg across, or what a file's camera states.
    pub field_of_view: Option<FieldOfView>,
    /// Width of the sensor, metres: gives focal lengths and f-numbers their meaning.
    pub sensor_width: f64,
    /// The opening of the lens.
    pub aperture: Aperture,
    /// Distance along the view at which points are sharp, metres; `None` takes that of the target.
    pub focus_distance: Option<f64>,
    /// Where it is stated.
    pub place: Place,
}

impl CameraDescription {
    /// A pinhole camera with +z up that sees 40 deg across.
    pub fn look_at(eye: [f64; 3], target: [f64; 3]) -> Self {
        CameraDescription {
            view: View::LookAt { eye, target, up: [0.0, 0.0, 1.0] },
            field_of_view: None,
            sensor_width: 0.036,
            aperture: Aperture::Pinhole,
            focus_distance: None,
            place: Place::NONE,
        }
    }
}

/// Where a camera stands.
#[derive(Clone, Debug)]
pub enum View {
    /// From `eye` to `target`, with `up` upward.
    LookAt {
        /// Position, metres.
        eye: [f64; 3],
        /// The point in the middle of the picture, metres.
        target: [f64; 3],
        /// The direction that is up.
        up: [f64; 3],
    },
    /// By its transform: local -z looks forward, +y up.
    Placed(Transform),
    /// As a camera of a glTF file.
    File {
        /// The file.
        file: PathBuf,
        /// The camera's name; `None` takes the first.
        name: Option<String>,
        /// Applied after the file's own transform.
        transform: Transform,
    },
}

/// How much a camera sees.
#[derive(Clone, Copy, Debug)]
pub enum FieldOfView {
    /// Full opening across the width, radians.
    Horizontal(f64),
    /// Full opening across the height, radians.
    Vertical(f64),
    /// Focal length in metres, with the camera's sensor width.
    FocalLength(f64),
}

/// The opening of a lens.
#[derive(Clone, Copy, Debug)]
pub enum Aperture {
    /// Everything is sharp.
    Pinhole,
    /// Diameter, metres.
    Diameter(f64),
    /// Focal length over diameter.
    FNumber(f64),
}

/// A material.
#[derive(Clone, Debug)]
pub struct MaterialDescription {
    /// The name that objects use.
    pub name: String,
    /// The id of a model.
    pub model: String,
    /// Parameters by name; the others have the model's defaults.
    pub params: Vec<(String, Source, Place)>,
    /// Whether an opaque surface scatters on its back.
    pub two_sided: bool,
    /// Where it is stated.
    pub place: Place,
}

impl MaterialDescription {
    /// A material with the model's defaults.
    pub fn new(name: impl Into<String>, model: impl Into<String>) -> Self {
        MaterialDescription {
            name: name.into(),
            model: model.into(),
            params: Vec::new(),
            two_sided: true,
            place: Place::NONE,
        }
    }

    /// The same with a constant parameter: one number, or one per channel.
    #[must_use]
    pub fn set(mut self, name: impl Into<String>, value: &[f64]) -> Self {
        self.params.push((name.into(), Source::Constant(value.to_vec()), Place::NONE));
        self
    }

    /// The same with a textured parameter.
    #[must_use]
    pub fn texture(mut self, name: impl Into<String>, texture: TextureDescription) -> Self {
        self.params.push((name.into(), Source::Texture(texture), Place::NONE));
        self
    }
}

/// Where a parameter comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// One number, or one per channel.
    Constant(Vec<f64>),
    /// An image.
    Texture(TextureDescription),
}

/// Where an image comes from.
#[derive(Clone)]
pub enum Picture {
    /// A file: EXR, HDR, PNG or JPEG.
    File(PathBuf),
    /// The bytes of such a file.
    Encoded(Arc<[u8]>),
    /// An image in memory.
    Image(Arc<Image>),
}

/// The source, without the pixels.
impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Picture::File(file) => write!(f, "File({file:?})"),
            Picture::Encoded(bytes) => write!(f, "Encoded({} bytes)", bytes.len()),
            Picture::Image(image) => write!(f, "Image({} x {})", image.width(), image.height()),
        }
    }
}

/// An image on a parameter: the value is `scale * texel + offset`, clamped to the legal range.
#[derive(Clone, Debug)]
pub struct TextureDescription {
    /// The image.
    pub image: Picture,
    /// Colour or data; `None` takes what the parameter is.
    pub role: Option<Role>,
    /// Whether a file is taken as sRGB-encoded; `None` takes what its format says.
    pub srgb: Option<bool>,
    /// The number of a texel that a scalar reads.
    pub channel: Channel,
    /// Factor, per channel.
    pub scale: [f64; 3],
    /// Added after the factor.
    pub offset: f64,
    /// How it continues beyond 0 to 1.
    pub wrap: [Wrap; 2],
    /// Whether texels are blended.
    pub interpolation: Interpolation,
    /// Factor and offset of the texture coordinates.
    pub uv: [[f32; 2]; 2],
}

impl TextureDescription {
    /// An image as it is.
    pub fn new(image: Picture) -> Self {
        TextureDescription {
            image,
            role: None,
            srgb: None,
            channel: Channel::Red,
            scale: [1.0; 3],
            offset: 0.0,
            wrap: [Wrap::Repeat; 2],
            interpolation: Interpolation::Bilinear,
            uv: [[1.0; 2], [0.0; 2]],
        }
    }
}

/// Objects under one name, to be placed several times.
#[derive(Clone, Debug)]
pub struct GroupDescription {
    /// The name that instances use.
    pub name: String,
    /// What it consists of.
    pub objects: Vec<ObjectDescription>,
    /// Where it is stated.
    pub place: Place,
}

/// A shape, a file or a group at a place.
#[derive(Clone, Debug)]
pub struct ObjectDescription {
    /// Its name in reports; may be empty.
    pub name: String,
    /// What it is.
    pub shape: Shape,
    /// Where it is.
    pub transform: Transform,
    /// The name of its material; a file's own materials are used where there is none.
    pub material: Option<String>,
    /// The light that its surface emits.
    pub light: Option<AreaLightDescription>,
    /// Where it is stated.
    pub place: Place,
}

impl ObjectDescription {
    /// A shape at the origin.
    pub fn new(shape: Shape) -> Self {
        ObjectDescription {
            name: String::new(),
            shape,
            transform: Transform::IDENTITY,
            material: None,
            light: None,
            place: Place::NONE,
        }
    }

    /// The same with a material.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>) -> Self {
        self.material = Some(name.into());
        self
    }

    /// The same at a place.
    #[must_use]
    pub fn at(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }

    /// The same shining from its outer side.
    #[must_use]
    pub fn light(mut self, emission: Emission) -> Self {
        self.light = Some(AreaLightDescription { emission, two_sided: false });
        self
    }
}

/// The form of an object.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Around the origin.
    Sphere {
        /// Metres.
        radius: f64,
    },
    /// In the plane z = 0, normal +z.
    Disk {
        /// Metres.
        radius: f64,
    },
    /// In the plane z = 0 around the origin, normal +z.
    Rectangle {
        /// Width along x and height along y, metres.
        size: [f64; 2],
    },
    /// Around the origin, along the axes.
    Cube {
        /// Edges along x, y and z, metres.
        size: [f64; 3],
    },
    /// Around the z axis, from z = 0 upward.
    Cylinder {
        /// Metres.
        radius: f64,
        /// Metres.
        height: f64,
        /// Whether disks close both ends.
        capped: bool,
    },
    /// The Utah teapot on the plane z = 0.
    Teapot {
        /// Subdivision: each patch has level x level cells.
        level: u32,
    },
    /// Triangles from a program.
    Mesh(Triangles),
    /// All of an OBJ, PLY or glTF file, with its materials and lights.
    File {
        /// The file.
        file: PathBuf,
        /// What to do about shading normals.
        normals: Normals,
    },
    /// The objects of a group.
    Group(String),
}

/// A mesh of a program; shared, so that the same mesh is kept once.
#[derive(Clone)]
pub struct Triangles(pub Arc<Mesh>);

/// The size, without the triangles.
impl fmt::Debug for Triangles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh({} triangles)", self.0.triangles().len())
    }
}

/// Shading normals of a mesh from a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// As the file has them; flat where it has none.
    #[default]
    File,
    /// Averaged over the faces around each vertex.
    Smooth,
    /// One per triangle.
    Flat,
}

/// How strong a light is, and of which colour.
#[derive(Clone, Debug)]
pub struct Emission {
    /// lm, cd, lx or cd/m²; with a spectrum also W, W/sr, W/m² or W/m²/sr.
    pub amount: Quantity,
    /// The colour.
    pub color: LightColor,
    /// Where it is stated.
    pub place: Place,
}

impl Emission {
    /// White light.
    pub fn new(amount: Quantity) -> Self {
        Emission { amount, color: LightColor::White, place: Place::NONE }
    }

    /// Light of a named spectrum.
    pub fn of(amount: Quantity, spectrum: Spectrum) -> Self {
        Emission { amount, color: LightColor::Spectrum(spectrum), place: Place::NONE }
    }
}

/// The colour of a light; it does not change how strong the light is.
#[derive(Clone, Copy, Debug)]
pub enum LightColor {
    /// The white of the film, D65.
    White,
    /// Linear Rec.709, of which only the ratios count.
    Rgb([f64; 3]),
    /// A named spectrum.
    Spectrum(Spectrum),
}

/// Light from a surface.
#[derive(Clone, Debug)]
pub struct AreaLightDescription {
    /// Flux or luminance.
    pub emission: Emission,
    /// Whether both sides shine.
    pub two_sided: bool,
}

/// A light that is no surface.
#[derive(Clone, Debug)]
pub struct LightDescription {
    /// Its name in reports; may be empty.
    pub name: String,
    /// What it is.
    pub kind: LightKind,
    /// How strong.
    pub emission: Emission,
    /// Where it is stated.
    pub place: Place,
}

impl LightDescription {
    /// A light without a name.
    pub fn new(kind: LightKind, emission: Emission) -> Self {
        LightDescription { name: String::new(), kind, emission, place: Place::NONE }
    }
}

/// The kind of a light.
#[derive(Clone, Copy, Debug)]
pub enum LightKind {
    /// Into all directions: flux or intensity.
    Point {
        /// Metres.
        position: [f64; 3],
    },
    /// Into a cone: flux or axial intensity.
    Spot {
        /// Metres.
        position: [f64; 3],
        /// The axis.
        direction: [f64; 3],
        /// Half angles of full intensity and of the edge, radians.
        half_angles: [f64; 2],
    },
    /// From infinitely far: perpendicular illuminance.
    Directional {
        /// In which the light travels.
        direction: [f64; 3],
    },
}

/// What lies behind everything.
#[derive(Clone, Debug)]
pub struct EnvironmentDescription {
    /// A picture or a constant.
    pub kind: EnvironmentKind,
    /// Which axis points to the zenith.
    pub up: Up,
    /// Where it is stated.
    pub place: Place,
}

/// The kind of an environment.
#[derive(Clone, Debug)]
pub enum EnvironmentKind {
    /// A latitude-longitude map.
    Map {
        /// The picture.
        image: Picture,
        /// Turn about the zenith, counter-clockwise seen from above, radians.
        rotation: f64,
        /// What its numbers mean.
        strength: MapStrength,
    },
    /// The same luminance everywhere.
    Sky {
        /// Luminance, or the illuminance of a horizontal plane.
        emission: Emission,
        /// Whether it ends at the horizon.
        dome: bool,
    },
}

/// How strong an environment map is.
#[derive(Clone, Copy, Debug)]
pub enum MapStrength {
    /// cd/m² per unit of the picture.
    Scale(f64),
    /// Illuminance of a horizontal plane by the upper half, lx.
    Illuminance(f64),
    /// Mean luminance over all directions, cd/m².
    Luminance(f64),
}
