//! Pinhole and thin-lens cameras.

use lesk_geometry::{Ray, Transform};
use lesk_math::{Vec3, vec3};
use std::f32::consts::FRAC_PI_4;

/// A camera with a flat film: local -z looks forward, +y up, +x to the right.
///
/// What it measures is the luminance along the ray of a place on the film; nothing darkens towards the corners.
#[derive(Clone, Debug)]
pub struct Camera {
    world_from_local: Transform,
    /// Width and height of the film in pixels.
    size: [f32; 2],
    /// Tangents of half the opening angles, across and up.
    tan_half: [f64; 2],
    lens_radius: f64,
    focus_distance: f64,
}

impl Camera {
    /// A camera at a place, for a film of `size` pixels, with the full horizontal opening angle in radians, the lens
    /// radius in metres (0 is a pinhole) and the distance in metres along the view at which points are sharp.
    ///
    /// # Errors
    /// A sentence for: a film without pixels, an angle outside 1e-4 rad to 179.9 deg, a lens radius that is negative
    /// or not finite, a focus distance that is not positive and finite, a place that is not a rotation and a move.
    pub fn new(
        world_from_local: Transform,
        size: [u32; 2],
        horizontal_fov: f64,
        lens_radius: f64,
        focus_distance: f64,
    ) -> Result<Self, String> {
        let widest = 179.9f64.to_radians();
        if size.contains(&0) {
            return Err(format!("film is {} x {} pixels, at least 1 x 1 is needed", size[0], size[1]));
        }
        if !(1e-4..=widest).contains(&horizontal_fov) {
            let deg = horizontal_fov.to_degrees();
            return Err(format!("camera has the horizontal field of view {deg} deg, 0.006 to 179.9 deg is accepted"));
        }
        if !(0.0..=1e6).contains(&lens_radius) {
            return Err(format!("camera has the lens radius {lens_radius} m, 0 to 1e6 m is accepted"));
        }
        if !(focus_distance > 0.0 && focus_distance <= 1e12) {
            return Err(format!(
                "camera has the focus distance {focus_distance} m, up to 1e12 m is accepted, 0 excluded"
            ));
        }
        let rigid = world_from_local.uniform_scale().is_some_and(|s| (s - 1.0).abs() < 1e-4);
        if !(rigid && world_from_local.determinant() > 0.0) {
            return Err("camera is scaled, mirrored or sheared, only rotations and moves are accepted".into());
        }
        let tan_x = (0.5 * horizontal_fov).tan();
        let tan_half = [tan_x, tan_x * f64::from(size[1]) / f64::from(size[0])];
        let size = size.map(|n| n as f32);
        Ok(Camera { world_from_local, size, tan_half, lens_radius, focus_distance })
    }

    /// The ray of a place on the film, in pixels from its upper left corner, through the point of the lens that the two
    /// numbers in [0, 1) choose. The direction has unit length: `t` counts metres.
    pub fn ray(&self, film: [f32; 2], lens: [f32; 2]) -> Ray {
        let x = (2.0 * f64::from(film[0] / self.size[0]) - 1.0) * self.tan_half[0];
        let y = (1.0 - 2.0 * f64::from(film[1] / self.size[1])) * self.tan_half[1];
        let mut origin = Vec3::ZERO;
        let mut direction = vec3(x, y, -1.0);
        if self.lens_radius > 0.0 {
            let [a, b] = disk(lens);
            origin = vec3(f64::from(a) * self.lens_radius, f64::from(b) * self.lens_radius, 0.0);
            direction = direction * self.focus_distance - origin;
        }
        let narrow = |v: Vec3<f64>| v.map(|x| x as f32);
        let d = self.world_from_local.vector_f64(direction).normalize();
        Ray::new(narrow(self.world_from_local.point_f64(origin)), narrow(d))
    }

    /// Where the camera stands.
    pub fn world_from_local(&self) -> &Transform {
        &self.world_from_local
    }

    /// Position, metres.
    pub fn position(&self) -> Vec3<f32> {
        self.world_from_local.point(Vec3::ZERO)
    }

    /// Radius of the lens, metres; 0 for a pinhole.
    pub fn lens_radius(&self) -> f64 {
        self.lens_radius
    }

    /// Full horizontal opening angle, radians.
    pub fn horizontal_fov(&self) -> f64 {
        2.0 * self.tan_half[0].atan()
    }

    /// Distance along the view at which points are sharp, metres.
    pub fn focus_distance(&self) -> f64 {
        self.focus_distance
    }
}

/// Shirley & Chiu, *A Low Distortion Map Between Disk and Square*, 1997.
fn disk(u: [f32; 2]) -> [f32; 2] {
    let [a, b] = u.map(|u| 2.0 * u - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0; 2];
    }
    let (r, phi) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (a / b)) };
    [r * phi.cos(), r * phi.sin()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(fov_deg: f64, lens: f64, focus: f64) -> Camera {
        let place = Transform::look_at(vec3(0.0, -4.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)).unwrap();
        Camera::new(place, [200, 100], fov_deg.to_radians(), lens, focus).unwrap()
    }

    fn close(a: Vec3<f32>, b: Vec3<f32>) {
        assert!((a - b).length() < 4.0 * f32::EPSILON, "{a:?} is not {b:?}");
    }

    #[test]
    fn middle_of_the_film_looks_at_the_target_and_the_right_edge_half_the_angle_beside_it() {
        let camera = camera(90.0, 0.0, 1.0);
        close(camera.ray([100.0, 50.0], [0.3, 0.8]).d, vec3(0.0, 1.0, 0.0));
        let half = 0.5f32.sqrt();
        close(camera.ray([200.0, 50.0], [0.0, 0.0]).d, vec3(half, half, 0.0));
        // twice as wide as high: the tangent upward is half of that to the side
        let n = (1.0f32 + 0.25).sqrt().recip();
        close(camera.ray([100.0, 0.0], [0.0, 0.0]).d, vec3(0.0, n, 0.5 * n));
    }

    #[test]
    fn rays_of_one_place_meet_in_the_plane_of_focus() {
        let camera = camera(40.0, 0.05, 3.0);
        let at_focus = |ray: Ray| ray.at(3.0 / ray.d.y);
        let first = at_focus(camera.ray([20.0, 30.0], [0.5, 0.5]));
        for lens in [[0.0, 0.0], [0.9, 0.1], [0.3, 0.99]] {
            let ray = camera.ray([20.0, 30.0], lens);
            assert!((at_focus(ray) - first).length() < 1e-5, "{lens:?}"); // 3 m in f32: 16 roundings of 3e-7
            assert!((ray.o - camera.position()).length() <= 0.05 + 1e-6);
        }
    }

    #[test]
    fn unusable_cameras_are_refused() {
        let id = Transform::IDENTITY;
        for (place, size, fov, lens, focus) in [
            (id, [0, 5], 1.0, 0.0, 1.0),
            (id, [5, 5], 0.0, 0.0, 1.0),
            (id, [5, 5], f64::NAN, 0.0, 1.0),
            (id, [5, 5], 3.2, 0.0, 1.0),
            (id, [5, 5], 1.0, -1.0, 1.0),
            (id, [5, 5], 1.0, 0.0, 0.0),
            (Transform::scale(2.0, 2.0, 2.0).unwrap(), [5, 5], 1.0, 0.0, 1.0),
            (Transform::scale(-1.0, 1.0, 1.0).unwrap(), [5, 5], 1.0, 0.0, 1.0),
        ] {
            assert!(Camera::new(place, size, fov, lens, focus).is_err());
        }
    }
}
