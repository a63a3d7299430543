//! The tables of sensors and of measuring.

use super::sections::{ANGLE, LENGTH, POSITIVE};
use super::{Field, Kind, Variants, field, needed};
use Dimension::*;
use lesk_quantities::Dimension;

const RECEIVER: Field = field(
    "receiver",
    Kind::Choice(&["planar", "cylindrical", "semicylindrical", "spherical", "hemispherical"]),
    "How directions of light count; planar where absent.",
);
const NORMAL: Field = field(
    "normal",
    Kind::Numbers(3),
    "The direction that a plane or half sphere faces, or the axis of a cylinder; +z where absent.",
);
const FACING: Field = field("facing", Kind::Numbers(3), "The direction that the half of a cylinder faces.");
const TASK: Field = field("task", Kind::Text, "A row of EN 12464-1 to check against, for example \"office.writing\".");
const MIN_MEAN: Field = field(
    "min_mean",
    Kind::Quantity(&[Illuminance], POSITIVE),
    "Least mean maintained illuminance, instead of that of the task.",
);
const MIN_UNIFORMITY: Field =
    field("min_uniformity", Kind::Number([0.0, 1.0]), "Least uniformity min / mean, instead of that of the task.");
const POSITION: Field = needed("position", Kind::Numbers(3), "Metres.");
const DIRECTION: Field = field("direction", Kind::Numbers(3), "The line of sight.");
const TARGET: Field = field("target", Kind::Numbers(3), "A point on the line of sight, instead of `direction`.");

pub(crate) const MEASURE: &[Field] = &[
    field(
        "maintenance_factor",
        Kind::Number([0.01, 1.0]),
        "Maintained over initial illuminance, typically 0.8; 1, a new installation, where absent.",
    ),
    field(
        "error",
        Kind::Number([1e-6, 1.0]),
        "Relative standard error that every reading shall reach; 0.01 where absent.",
    ),
    field("max_depth", Kind::Integer([0, 65536]), "Most reflections of a path; 1024 where absent."),
];

pub(crate) const SENSOR: Variants = Variants {
    name: "sensor",
    tag: "type",
    common: &[
        needed("name", Kind::Text, "Its name in reports."),
        field(
            "quantity",
            Kind::Choice(&["photometric", "radiometric", "photons"]),
            "lx and cd/m2, W/m2 and W/m2/sr, or umol/m2/s and umol/m2/s/sr; photometric where absent.",
        ),
        field("spectrum", Kind::Text, "The spectrum that the light is taken to have, for watts and photons."),
    ],
    cases: &[
        ("point", &[POSITION, RECEIVER, NORMAL, FACING, TASK, MIN_MEAN]),
        (
            "line",
            &[
                needed("from", Kind::Numbers(3), "One end, metres."),
                needed("to", Kind::Numbers(3), "The other end, metres."),
                field("spacing", LENGTH, "Greatest distance of the points; that of EN 12464-1 where absent."),
                RECEIVER,
                NORMAL,
                FACING,
                TASK,
                MIN_MEAN,
                MIN_UNIFORMITY,
            ],
        ),
        (
            "grid",
            &[
                needed("corner", Kind::Numbers(3), "The corner where both edges begin, metres."),
                needed("u", Kind::Numbers(3), "The edge along a row of points, metres."),
                needed("v", Kind::Numbers(3), "The edge along a column, metres."),
                field("spacing", LENGTH, "Greatest distance of the points; that of EN 12464-1 where absent."),
                field("margin", LENGTH, "What is left out along all four edges; nothing where absent."),
                RECEIVER,
                field(
                    "normal",
                    Kind::Numbers(3),
                    "The direction that the planes face, or the axis of cylinders; u x v where absent.",
                ),
                FACING,
                TASK,
                MIN_MEAN,
                MIN_UNIFORMITY,
            ],
        ),
        (
            "luminance",
            &[
                POSITION,
                DIRECTION,
                TARGET,
                field("opening", ANGLE, "Full opening of the cone; \"1 deg\" where absent."),
            ],
        ),
        (
            "camera",
            &[
                needed("eye", Kind::Numbers(3), "Position, metres."),
                needed("target", Kind::Numbers(3), "The point in the middle of the picture, metres."),
                field("up", Kind::Numbers(3), "The direction that is up; [0, 0, 1] where absent."),
                field("fov", ANGLE, "Full field of view across the width; \"40 deg\" where absent."),
                field("size", Kind::Integers(2, [1, 2048]), "Width and height in pixels; [64, 48] where absent."),
                field(
                    "of",
                    Kind::Choice(&["luminance", "illuminance"]),
                    "The luminance along each ray, or the illuminance of the surface there; luminance where absent.",
                ),
            ],
        ),
        (
            "glare",
            &[
                needed("position", Kind::Numbers(3), "The eye, metres: 1.2 m above the floor for sitting observers."),
                DIRECTION,
                TARGET,
                field("up", Kind::Numbers(3), "The direction that is up; [0, 0, 1] where absent."),
                TASK,
                field("max_ugr", Kind::Number([5.0, 40.0]), "Greatest UGR, instead of that of the task."),
            ],
        ),
    ],
};
