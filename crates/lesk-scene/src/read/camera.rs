//! The camera of a scene file.

use super::fields::{Fields, Problems};
use super::objects::transform;
use crate::description::{Aperture, CameraDescription, FieldOfView, View};
use crate::error::Problem;

/// Where the camera is faulty or absent, so that the rest can be looked up.
pub(super) fn stand_in() -> CameraDescription {
    CameraDescription::look_at([0.0, -1.0, 0.0], [0.0; 3])
}

pub(super) fn camera(fields: &Fields, problems: &mut Problems) -> Option<CameraDescription> {
    let mut camera = stand_in();
    camera.place = fields.place;
    camera.view = view(fields, problems)?;
    camera.sensor_width = fields.si("sensor_width").unwrap_or(camera.sensor_width);
    camera.focus_distance = fields.si("focus_distance");
    camera.field_of_view = match fields.one_of(&["fov", "fov_y", "focal_length"], problems) {
        Some("fov") => fields.si("fov").map(FieldOfView::Horizontal),
        Some("fov_y") => fields.si("fov_y").map(FieldOfView::Vertical),
        Some(_) => fields.si("focal_length").map(FieldOfView::FocalLength),
        None => None,
    };
    for name in ["fov", "fov_y"] {
        if let Some(angle) = fields.si(name).filter(|a| !(1e-4..=3.139).contains(a)) {
            let text = format!("`{name}` is {} deg, 0.006 to 179.8 deg is accepted", angle.to_degrees());
            problems.add(Problem::new(fields.place_of(name), text));
        }
    }
    camera.aperture = match fields.one_of(&["f_number", "aperture"], problems) {
        Some("f_number") => fields.number("f_number").map_or(Aperture::Pinhole, Aperture::FNumber),
        Some(_) => fields.si("aperture").map_or(Aperture::Pinhole, Aperture::Diameter),
        None => Aperture::Pinhole,
    };
    Some(camera)
}

fn view(fields: &Fields, problems: &mut Problems) -> Option<View> {
    if fields.has("file") {
        for name in ["eye", "target", "up"].into_iter().filter(|n| fields.has(n)) {
            let text = format!("`{name}` and `file` are both there, one of them is accepted");
            problems.add(Problem::new(fields.place_of(name), text));
        }
        return Some(View::File {
            file: fields.text("file")?.into(),
            name: fields.text("name").map(str::to_string),
            transform: transform(fields, problems)?,
        });
    }
    for name in ["name", "transform"].into_iter().filter(|n| fields.has(n)) {
        let text = format!("`{name}` is for a camera of a file");
        problems.add(Problem::new(fields.place_of(name), text).hint("give `file`, or `eye` and `target`"));
    }
    for name in ["eye", "target"].into_iter().filter(|n| !fields.has(n)) {
        let text = format!("camera has no `{name}`");
        let hint = "a camera needs `eye` and `target`, three numbers in metres each, or `file`";
        problems.add(Problem::new(fields.place, text).hint(hint));
    }
    Some(View::LookAt {
        eye: fields.numbers("eye")?,
        target: fields.numbers("target")?,
        up: if fields.has("up") { fields.numbers("up")? } else { [0.0, 0.0, 1.0] },
    })
}
