//! The camera, from numbers or from a file.

use super::Resolver;
use crate::Camera;
use crate::description::{Aperture, FieldOfView, View};
use crate::error::{Problem, list, name_hint};
use lesk_geometry::Transform;
use lesk_geometry::import::Projection;
use lesk_math::{Vec3, vec3};
use std::path::Path;

/// Full horizontal opening of a camera that states none.
const USUAL_FIELD_OF_VIEW_DEG: f64 = 40.0;

impl Resolver<'_> {
    pub(super) fn camera(&mut self) -> Option<Camera> {
        let d = &self.description.camera;
        let film = &self.description.film;
        let aspect = f64::from(film.height) / f64::from(film.width);
        let place = d.place;
        let mut from_file = None;
        let (world_from_local, distance) = match &d.view {
            View::LookAt { eye, target, up } => {
                let [eye, target, up] = [*eye, *target, *up].map(Vec3::from);
                let result = Transform::look_at(eye, target, up);
                (self.check(place, "", result)?, Some((target - eye).length()))
            }
            View::Placed(transform) => (*transform, None),
            View::File { file, name, transform } => {
                let (from, fov) = self.camera_of(file, name.as_deref())?;
                from_file = Some(FieldOfView::Vertical(fov));
                (rigid(&(*transform * from)).unwrap_or(*transform * from), None)
            }
        };
        let usual = FieldOfView::Horizontal(USUAL_FIELD_OF_VIEW_DEG.to_radians());
        let fov = match d.field_of_view.or(from_file).unwrap_or(usual) {
            FieldOfView::Horizontal(angle) => angle,
            FieldOfView::Vertical(angle) => 2.0 * ((0.5 * angle).tan() / aspect).atan(),
            FieldOfView::FocalLength(length) => 2.0 * (0.5 * d.sensor_width / length).atan(),
        };
        let focal_length = 0.5 * d.sensor_width / (0.5 * fov).tan();
        let lens_radius = match d.aperture {
            Aperture::Pinhole => 0.0,
            Aperture::Diameter(diameter) => 0.5 * diameter,
            Aperture::FNumber(number) => 0.5 * focal_length / number,
        };
        if lens_radius > 0.0 && d.focus_distance.or(distance).is_none() {
            let problem = Problem::new(place, "camera has a lens but no focus distance");
            self.problem(problem.hint("add `focus_distance`, for example \"2 m\""));
            return None;
        }
        let focus = d.focus_distance.or(distance).unwrap_or(1.0);
        let camera = Camera::new(world_from_local, [film.width, film.height], fov, lens_radius, focus);
        self.check(place, "", camera)
    }

    /// Place and vertical opening of a camera of a file.
    fn camera_of(&mut self, file: &Path, name: Option<&str>) -> Option<(Transform, f64)> {
        let place = self.description.camera.place;
        let asset = self.files.asset(file);
        let (path, asset) = self.check(place, "camera", asset)?;
        let shown = path.display();
        let found = match name {
            Some(name) => asset.cameras.iter().find(|c| c.name == name),
            None => asset.cameras.first(),
        };
        let Some(camera) = found else {
            let names: Vec<&str> = asset.cameras.iter().map(|c| c.name.as_str()).collect();
            self.problem(match name {
                _ if names.is_empty() => Problem::new(place, format!("`{shown}` has no camera"))
                    .hint("give `eye` and `target` instead of `file`"),
                Some(name) => Problem::new(place, format!("`{shown}` has no camera `{name}`, it has {}", list(&names)))
                    .hint(name_hint(name, &names)),
                None => Problem::new(place, format!("`{shown}` has no camera")),
            });
            return None;
        };
        match camera.projection {
            Projection::Perspective { vertical_fov, .. } => Some((camera.world_from_local, f64::from(vertical_fov))),
            Projection::Orthographic { .. } => {
                let text =
                    format!("camera `{}` of `{shown}` is orthographic, perspective cameras are accepted", camera.name);
                self.problem(Problem::new(place, text));
                None
            }
        }
    }
}

/// The transform without its scale: a camera keeps its view when the nodes above it are scaled.
fn rigid(t: &Transform) -> Option<Transform> {
    let eye = t.point_f64(Vec3::ZERO);
    let target = eye + t.vector_f64(vec3(0.0, 0.0, -1.0)).normalize();
    Transform::look_at(eye, target, t.vector_f64(vec3(0.0, 1.0, 0.0)).normalize()).ok()
}
