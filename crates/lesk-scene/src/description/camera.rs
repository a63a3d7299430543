//! The camera of a scene.

use crate::error::Place;
use lesk_geometry::Transform;
use std::path::PathBuf;

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
