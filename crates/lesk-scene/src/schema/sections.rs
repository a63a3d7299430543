//! The table.

use super::{Field, Kind, MEASURE, RASTER, SENSOR, Section, Variants, field, needed};
use crate::scene::ShadowTerminator;
use Dimension::*;
use lesk_quantities::Dimension;

pub(super) const POSITIVE: [f64; 2] = [f64::MIN_POSITIVE, f64::MAX];
pub(super) const ANY: [f64; 2] = [f64::MIN, f64::MAX];
pub(super) const LENGTH: Kind = Kind::Quantity(&[Length], [1e-9, 1e12]);
pub(super) const ANGLE: Kind = Kind::Quantity(&[Angle], ANY);

/// The version of scene files.
pub(crate) const VERSION: i64 = 1;

pub(crate) const ROOT: &[Field] = &[
    needed("version", Kind::Integer([VERSION, VERSION]), "Version of the format: 1."),
    field("title", Kind::Text, "A line that says what the scene shows."),
    needed("camera", Kind::Table(Section::Plain("camera", CAMERA)), "Where the picture is taken from."),
    field("film", Kind::Table(Section::Plain("film", FILM)), "Size and filter of the picture."),
    field("render", Kind::Table(Section::Plain("render", RENDER)), "How to render."),
    field("raster", Kind::Table(Section::Plain("raster", RASTER)), "How to shade with `--engine raster`."),
    field("materials", Kind::Named(Section::Material), "Materials by name."),
    field("groups", Kind::Named(Section::Plain("group", GROUP)), "Objects that are placed as one, by name."),
    field("objects", Kind::List(Section::Variants(&OBJECT)), "What is there."),
    field("lights", Kind::List(Section::Variants(&LIGHT)), "Lights that are no surface."),
    field("sensors", Kind::List(Section::Variants(&SENSOR)), "Where light is measured."),
    field("measure", Kind::Table(Section::Plain("measure", MEASURE)), "How light is measured."),
    field("environment", Kind::Table(Section::Variants(&ENVIRONMENT)), "What lies behind everything."),
];

pub(crate) const CAMERA: &[Field] = &[
    field("eye", Kind::Numbers(3), "Position, metres."),
    field("target", Kind::Numbers(3), "The point in the middle of the picture, metres."),
    field("up", Kind::Numbers(3), "The direction that is up; [0, 0, 1] where absent."),
    field("file", Kind::Text, "A glTF file whose camera is taken, instead of `eye` and `target`."),
    field("name", Kind::Text, "The camera of that file; the first where absent."),
    field("transform", Kind::Steps, "Where the camera of the file is moved to."),
    field("fov", ANGLE, "Full field of view across the width, for example \"40 deg\", which is also the default."),
    field("fov_y", ANGLE, "Full field of view across the height, instead of `fov`."),
    field("focal_length", LENGTH, "Focal length, instead of a field of view."),
    field("sensor_width", LENGTH, "Width of the sensor; \"36 mm\" where absent."),
    field("f_number", Kind::Number([1e-3, 1e6]), "Focal length over the diameter of the lens; a pinhole where absent."),
    field("aperture", LENGTH, "Diameter of the lens, instead of `f_number`."),
    field("focus_distance", LENGTH, "Distance along the view of what is sharp; that of `target` where absent."),
    field("ev100", Kind::Exposure, "Exposure value at ISO 100; metered where absent."),
];

/// Largest side of a film.
const SIDE: [i64; 2] = [1, 65536];

pub(crate) const FILM: &[Field] = &[
    field("size", Kind::Integers(2, SIDE), "Width and height in pixels; [640, 480] where absent."),
    field(
        "filter",
        Kind::Choice(&["blackman_harris", "gaussian", "tent", "box"]),
        "Pixel filter; blackman_harris where absent.",
    ),
    field(
        "filter_radius",
        Kind::Number([0.1, 10.0]),
        "Half width of the filter in pixels (three standard deviations of a gaussian); its usual one where absent.",
    ),
];

pub(crate) const RENDER: &[Field] = &[
    field("spp", Kind::Integer([1, 1 << 24]), "Samples per pixel; 64 where absent."),
    field("max_depth", Kind::Integer([0, 4096]), "Most scattering events of a path; 16 where absent."),
    field(
        "roulette_depth",
        Kind::Integer([0, 4096]),
        "Scattering events after which a path may end by Russian roulette; 3 where absent.",
    ),
    field("seed", Kind::Integer([0, i64::MAX]), "Seed of the random numbers; 0 where absent."),
    field(
        "split",
        Kind::Choices(&["direct", "indirect", "specular", "caustic"]),
        "Light paths that are also written as layers of their own.",
    ),
    field("aovs", Kind::Bool, "Whether albedo, normal, depth and ids are written; false where absent."),
    field(
        "shadow_terminator",
        Kind::Choice(ShadowTerminator::NAMES),
        "Where rays to lights start on faces with interpolated normals: hanika, raised to the surface that the faces stand \
         for; none, on the faces, whose shadows are blocks; hanika where absent.",
    ),
];

pub(crate) const MATERIAL_COMMON: &[Field] = &[
    field("two_sided", Kind::Bool, "Whether an opaque surface also scatters on its back; true where absent."),
    field("normal_map", Kind::Table(Section::Plain("normal map", NORMAL_MAP)), "A picture that bends the normals."),
];

pub(crate) const NORMAL_MAP: &[Field] = &[
    needed("file", Kind::Text, "A picture of normals: red along growing u, green along growing v, blue outward."),
    field("strength", Kind::Number([-1e3, 1e3]), "Factor of the slopes; 1 where absent."),
    WRAP,
    INTERPOLATION,
    UV_SCALE,
    UV_OFFSET,
];

const COLOR_SPACE: Field = field(
    "color_space",
    Kind::Choice(&["srgb", "linear"]),
    "How the file encodes colours; what its format says where absent.",
);
const WRAP: Field =
    field("wrap", Kind::Choice(&["repeat", "mirror", "clamp"]), "How it continues beyond 0 to 1; repeat where absent.");
const INTERPOLATION: Field =
    field("interpolation", Kind::Choice(&["bilinear", "nearest"]), "Between texels; bilinear where absent.");
const UV_SCALE: Field = field("uv_scale", Kind::Numbers(2), "Factor of the texture coordinates; [1, 1] where absent.");
const UV_OFFSET: Field =
    field("uv_offset", Kind::Numbers(2), "Added to the scaled texture coordinates; [0, 0] where absent.");

pub(crate) const TEXTURE: &[Field] = &[
    needed("file", Kind::Text, "An EXR, HDR, PNG or JPEG file."),
    field("role", Kind::Choice(&["color", "data"]), "Colours are decoded to linear light, data never."),
    COLOR_SPACE,
    field(
        "channel",
        Kind::Choice(&["r", "g", "b", "a", "luminance"]),
        "The number of a texel that a scalar reads; r where absent.",
    ),
    field("scale", Kind::NumberOr(3), "Factor of the texel; 1 where absent."),
    field("offset", Kind::Number([-1e9, 1e9]), "Added after the factor; 0 where absent."),
    WRAP,
    INTERPOLATION,
    UV_SCALE,
    UV_OFFSET,
];

pub(crate) const GROUP: &[Field] =
    &[needed("objects", Kind::List(Section::Variants(&OBJECT)), "What the group consists of.")];

pub(crate) const OBJECT: Variants = Variants {
    name: "object",
    tag: "shape",
    common: &[
        field("name", Kind::Text, "Its name in reports."),
        field("transform", Kind::Steps, "Where it is: steps, applied in their order."),
        field("material", Kind::Text, "The name of its material; those of a file are used where absent."),
        field("light", Kind::Table(Section::Plain("light", AREA_LIGHT)), "The light that its surface emits."),
    ],
    cases: &[
        ("sphere", &[field("radius", LENGTH, "Radius; \"1 m\" where absent.")]),
        ("disk", &[field("radius", LENGTH, "Radius; \"1 m\" where absent.")]),
        (
            "rectangle",
            &[
                field("width", LENGTH, "Extent along x; \"1 m\" where absent."),
                field("height", LENGTH, "Extent along y; \"1 m\" where absent."),
            ],
        ),
        (
            "cube",
            &[
                field("edge", LENGTH, "All three edges; \"1 m\" where absent."),
                field("size", Kind::Numbers(3), "Extents along x, y and z in metres, instead of `edge`."),
            ],
        ),
        (
            "cylinder",
            &[
                field("radius", LENGTH, "Radius; \"1 m\" where absent."),
                field("height", LENGTH, "Extent along z; \"1 m\" where absent."),
                field("capped", Kind::Bool, "Whether both ends are closed; true where absent."),
            ],
        ),
        ("teapot", &[field("level", Kind::Integer([1, 256]), "Cells along each side of a patch; 16 where absent.")]),
        (
            "mesh",
            &[
                needed("file", Kind::Text, "An OBJ, PLY, glTF or GLB file: all that it holds."),
                field(
                    "normals",
                    Kind::Choice(&["file", "smooth", "flat"]),
                    "Shading normals: those of the file, smooth or flat; file where absent.",
                ),
            ],
        ),
        ("group", &[needed("group", Kind::Text, "The name of a group.")]),
    ],
};

const COLOR_DOC: &str = "Linear Rec.709 colour, of which only the ratios count; white where absent.";
const COLOR: Field = field("color", Kind::Numbers(3), COLOR_DOC);
const TEMPERATURE: Field =
    field("temperature", Kind::Quantity(&[Temperature], [500.0, 1e5]), "Colour of a black body, instead of `color`.");
const SPECTRUM: Field = field(
    "spectrum",
    Kind::Text,
    "E, A, D50, D65, FL2, LED-B3 or another illuminant of the CIE, or \"blackbody 2700 K\", instead of `color`; needed for amounts in watts.",
);
const FLUX: Field = field("flux", Kind::Quantity(&[LuminousFlux, RadiantFlux], POSITIVE), "Flux, lm or W.");
const INTENSITY: Field = field(
    "intensity",
    Kind::Quantity(&[LuminousIntensity, RadiantIntensity], POSITIVE),
    "Intensity, on the axis of a spot, cd or W/sr.",
);
const LUMINANCE: Field =
    field("luminance", Kind::Quantity(&[Luminance, Radiance], POSITIVE), "Luminance or radiance, cd/m2 or W/m2/sr.");
const ILLUMINANCE: Field = field(
    "illuminance",
    Kind::Quantity(&[Illuminance, Irradiance], POSITIVE),
    "Illuminance or irradiance, lx or W/m2: of a plane perpendicular to parallel light, of a horizontal plane by a sky.",
);

const ELEVATION: Field = field("elevation", ANGLE, "Of the sun, above the horizon.");
const AZIMUTH: Field =
    field("azimuth", ANGLE, "Of the sun: from north (+y), clockwise over east (+x); 0 where absent.");
const LATITUDE: Field = field("latitude", ANGLE, "Of the place, north positive, instead of `elevation`.");
const LONGITUDE: Field = field("longitude", ANGLE, "Of the place, east positive.");
const TIME: Field = field("time", Kind::Text, "With its zone, for example \"2025-06-21T14:00+02:00\".");
const TURBIDITY: Kind = Kind::Number(lesk_light::HosekSky::TURBIDITIES);

/// The keys of which an emission needs exactly one.
pub(crate) const AMOUNTS: [&str; 4] = ["flux", "intensity", "luminance", "illuminance"];
/// The keys of which an emission takes at most one.
pub(crate) const COLORS: [&str; 3] = ["color", "temperature", "spectrum"];

pub(crate) const AREA_LIGHT: &[Field] = &[
    FLUX,
    LUMINANCE,
    COLOR,
    TEMPERATURE,
    SPECTRUM,
    field("two_sided", Kind::Bool, "Whether both sides shine; false where absent. The flux is that of both together."),
    field(
        "texture",
        Kind::Table(Section::Plain("light texture", LIGHT_TEXTURE)),
        "A picture on the surface: a luminance is that of its white, a flux that of the whole.",
    ),
];

pub(crate) const LIGHT_TEXTURE: &[Field] = &[
    needed("file", Kind::Text, "An EXR, HDR, PNG or JPEG file."),
    COLOR_SPACE,
    WRAP,
    INTERPOLATION,
    UV_SCALE,
    UV_OFFSET,
];

pub(crate) const LIGHT: Variants = Variants {
    name: "light",
    tag: "type",
    common: &[field("name", Kind::Text, "Its name in reports."), COLOR, TEMPERATURE, SPECTRUM],
    cases: &[
        ("point", &[needed("position", Kind::Numbers(3), "Metres."), FLUX, INTENSITY]),
        (
            "spot",
            &[
                needed("position", Kind::Numbers(3), "Metres."),
                field("direction", Kind::Numbers(3), "The axis of the cone."),
                field("target", Kind::Numbers(3), "A point on the axis, instead of `direction`."),
                needed("outer", ANGLE, "From the axis to the edge of the cone."),
                field(
                    "inner",
                    ANGLE,
                    "From the axis to where the intensity begins to fall; three quarters of `outer` where absent.",
                ),
                FLUX,
                INTENSITY,
            ],
        ),
        (
            "directional",
            &[
                needed("direction", Kind::Numbers(3), "The direction in which the light travels."),
                field(
                    "diameter",
                    ANGLE,
                    "Angular diameter of the disk that it comes from; parallel light where absent.",
                ),
                ILLUMINANCE,
            ],
        ),
        (
            "sun",
            &[
                ELEVATION,
                AZIMUTH,
                LATITUDE,
                LONGITUDE,
                TIME,
                ILLUMINANCE,
                field(
                    "turbidity",
                    TURBIDITY,
                    "Of the air, instead of `illuminance` and a colour: those of the direct sun in a `hosek_sky`.",
                ),
            ],
        ),
        (
            "luminaire",
            &[
                needed("file", Kind::Text, "An IES or EULUMDAT file."),
                needed("position", Kind::Numbers(3), "Of the photometric centre, metres."),
                field("direction", Kind::Numbers(3), "Of nadir; [0, 0, -1] where absent."),
                field("target", Kind::Numbers(3), "A point on the axis, instead of `direction`."),
                field("rotation", ANGLE, "Turn about the axis, counter-clockwise seen from above; 0 where absent."),
                field("lamp_set", Kind::Integer([0, 19]), "Lamp set of an EULUMDAT file, from 0."),
                field("dimming", Kind::Number([1e-6, 1.0]), "Share of the full flux; 1 where absent."),
                field("maintenance", Kind::Number([1e-6, 1.0]), "Maintenance factor; 1 where absent."),
                FLUX,
            ],
        ),
        (
            "projector",
            &[
                needed("file", Kind::Text, "The picture: an EXR, HDR, PNG or JPEG file."),
                needed("position", Kind::Numbers(3), "Metres."),
                field("direction", Kind::Numbers(3), "The axis."),
                field("target", Kind::Numbers(3), "A point on the axis, instead of `direction`."),
                field("up", Kind::Numbers(3), "What is up in the picture; [0, 0, 1] where absent."),
                needed("width", ANGLE, "Full opening across the width of the picture."),
                FLUX,
            ],
        ),
    ],
};

pub(crate) const ENVIRONMENT: Variants = Variants {
    name: "environment",
    tag: "type",
    common: &[field(
        "up",
        Kind::Choice(&["z", "y"]),
        "The axis of the world that points to the zenith; z where absent.",
    )],
    cases: &[
        (
            "map",
            &[
                needed("file", Kind::Text, "A latitude-longitude picture, EXR or HDR."),
                field("rotation", ANGLE, "Turn about the zenith, counter-clockwise seen from above."),
                field(
                    "scale",
                    Kind::Number([f64::MIN_POSITIVE, 1e30]),
                    "cd/m2 per unit of the picture; 1 where absent.",
                ),
                field(
                    "illuminance",
                    Kind::Quantity(&[Illuminance], POSITIVE),
                    "Illuminance of a horizontal plane by the upper half, instead of `scale`.",
                ),
                field(
                    "luminance",
                    Kind::Quantity(&[Luminance], POSITIVE),
                    "Mean luminance over all directions, instead of `scale`.",
                ),
            ],
        ),
        (
            "sky",
            &[
                LUMINANCE,
                ILLUMINANCE,
                COLOR,
                TEMPERATURE,
                SPECTRUM,
                field("dome", Kind::Bool, "Whether it ends at the horizon; false where absent."),
            ],
        ),
        (
            "cie_sky",
            &[
                needed("number", Kind::Integer([1, 16]), "Type of CIE S 011; 16 is the traditional overcast sky."),
                ELEVATION,
                AZIMUTH,
                LATITUDE,
                LONGITUDE,
                TIME,
                field(
                    "ground",
                    Kind::Number([0.0, 1.0]),
                    "Reflectance of the ground below the horizon; 0 where absent.",
                ),
                LUMINANCE,
                ILLUMINANCE,
                COLOR,
                TEMPERATURE,
                SPECTRUM,
            ],
        ),
        (
            "hosek_sky",
            &[
                needed("turbidity", TURBIDITY, "Of the air: 2 is a very clear sky, 3 a clear one, 6 a hazy one."),
                ELEVATION,
                AZIMUTH,
                LATITUDE,
                LONGITUDE,
                TIME,
                field(
                    "ground",
                    Kind::NumberOr(3),
                    "Reflectance of the ground, a number or linear Rec.709, 0 to 1; it also brightens the sky; 0 where absent.",
                ),
            ],
        ),
    ],
};

/// The keys of a step of a transform; exactly one, `axis` goes with `rotate`.
pub(crate) const STEP: &[Field] = &[
    field("translate", Kind::Numbers(3), "Move, metres."),
    field("rotate", ANGLE, "Turn about `axis`, counter-clockwise seen against it."),
    field("axis", Kind::Numbers(3), "Axis of `rotate`; [0, 0, 1] where absent."),
    field("scale", Kind::NumberOr(3), "Factor, for all axes or for each; a negative one mirrors."),
    field("look_at", Kind::Table(Section::Plain("look_at", LOOK_AT)), "Stands at a point and turns +z to another."),
    field("matrix", Kind::Matrix, "Three rows of four numbers, the last column is the move in metres."),
];

pub(crate) const LOOK_AT: &[Field] = &[
    needed("from", Kind::Numbers(3), "Where the origin goes, metres."),
    needed("to", Kind::Numbers(3), "Where +z points, metres."),
    field("up", Kind::Numbers(3), "Where +y points as well as can be; [0, 0, 1] where absent."),
];
