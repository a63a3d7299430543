//! From world space to the screen.

use crate::error::{Error, Result};
use lesk_math::{Vec3, vec3};
use lesk_scene::Scene;

/// Steps of screen coordinates per pixel.
pub(crate) const STEPS: i32 = 256;

/// Screen coordinates in pixels reach this far; what lies beyond is clipped.
pub(crate) const GUARD: f64 = 16_000.0;

/// Widest film in samples: it must lie inside [`GUARD`].
const MAX_SIDE: u32 = 15_000;

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Screen {
    /// In steps from the upper left corner; [`Screen::CLIP`] where the vertex must be clipped.
    pub x: i32,
    pub y: i32,
    /// 1 / distance along the view, 1/m: nearer is larger, and linear on the screen.
    pub inverse_w: f32,
}

impl Screen {
    /// `x` of a vertex without a place on the screen.
    pub const CLIP: i32 = i32::MIN;
}

/// A vertex before the division: x/w and y/w are pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Homogeneous {
    pub x: f64,
    pub y: f64,
    pub w: f64,
}

/// The greatest whole number that is not above `v`, |v| < 2^31: without SSE4.1 the library function is a call.
#[inline]
fn floor(v: f64) -> i32 {
    let whole = v as i32;
    whole - i32::from(f64::from(whole) > v)
}

/// The camera as a map from world space to samples of the film.
#[derive(Clone, Debug)]
pub(crate) struct View {
    /// Samples across and down.
    pub width: u32,
    pub height: u32,
    rows: [[f64; 4]; 3],
    /// Eye, world space.
    pub eye: Vec3<f32>,
    eye_f64: Vec3<f64>,
    /// Axes of the camera, world space: right, up, back.
    axes: [Vec3<f64>; 3],
    /// x of the ray of each column of samples, at distance 1.
    columns: Vec<f64>,
    /// y of the ray of each row of samples.
    lines: Vec<f64>,
    /// Distance from which on points can be seen, metres.
    pub near: f64,
}

impl View {
    pub fn new(scene: &Scene, supersampling: u32, extent: f64) -> Result<Self> {
        let (width, height) = (scene.film.width * supersampling, scene.film.height * supersampling);
        if width.max(height) > MAX_SIDE {
            return Err(Error::new(format!(
                "film has {width} x {height} samples, at most {MAX_SIDE} a side are accepted"
            ))
            .hint("lower `supersampling` or the size of the film"));
        }
        let camera = &scene.camera;
        let tan_x = (0.5 * camera.horizontal_fov()).tan();
        let tan_y = tan_x * f64::from(height) / f64::from(width);
        let local = camera.world_from_local().inverse_rows();
        let row = |of: &dyn Fn(usize) -> f64| -> [f64; 4] { std::array::from_fn(of) };
        let (half_w, half_h) = (0.5 * f64::from(width), 0.5 * f64::from(height));
        let w = row(&|k| -local[2][k]);
        let rows = [
            row(&|k| local[0][k] * half_w / tan_x + half_w * w[k]),
            row(&|k| -local[1][k] * half_h / tan_y + half_h * w[k]),
            w,
        ];
        let place = camera.world_from_local();
        let axis = |v: Vec3<f64>| place.vector_f64(v).normalize();
        // as the camera computes its rays: the share of the film in f32
        let share = |k: u32, n: u32| f64::from((k as f32 + 0.5) / supersampling as f32 / (n / supersampling) as f32);
        Ok(View {
            width,
            height,
            rows,
            eye: camera.position(),
            eye_f64: place.point_f64(Vec3::ZERO),
            axes: [axis(vec3(1.0, 0.0, 0.0)), axis(vec3(0.0, 1.0, 0.0)), axis(Vec3::Z)],
            columns: (0..width).map(|x| (2.0 * share(x, width) - 1.0) * tan_x).collect(),
            lines: (0..height).map(|y| (1.0 - 2.0 * share(y, height)) * tan_y).collect(),
            near: (1e-5 * extent).max(1e-9),
        })
    }

    #[inline]
    pub fn project(&self, p: Vec3<f32>) -> Homogeneous {
        let [x, y, z] = p.to_array().map(f64::from);
        let dot = |r: &[f64; 4]| r[0] * x + r[1] * y + r[2] * z + r[3];
        Homogeneous { x: dot(&self.rows[0]), y: dot(&self.rows[1]), w: dot(&self.rows[2]) }
    }

    /// The vertex on the grid of the screen.
    #[inline]
    pub fn snap(&self, h: Homogeneous) -> Screen {
        let inverse_w = 1.0 / h.w;
        let (x, y) = (h.x * inverse_w, h.y * inverse_w);
        // fails for NaN too
        if h.w >= self.near && x.abs() <= GUARD && y.abs() <= GUARD {
            let grid = |v: f64| floor(v * f64::from(STEPS) + 0.5);
            Screen { x: grid(x), y: grid(y), inverse_w: inverse_w as f32 }
        } else {
            Screen { x: Screen::CLIP, y: 0, inverse_w: 0.0 }
        }
    }

    /// A point relative to the eye, in the axes of the camera, -z forward.
    #[inline]
    pub fn relative(&self, p: Vec3<f32>) -> Vec3<f64> {
        let d = p.map(f64::from) - self.eye_f64;
        vec3(self.axes[0].dot(d), self.axes[1].dot(d), self.axes[2].dot(d))
    }

    /// x of the rays through a column of samples, in the axes of the camera, at distance 1 along the view.
    #[inline(always)]
    pub fn column(&self, x: u32) -> f64 {
        self.columns[x as usize]
    }

    /// y of the rays through a row of samples.
    #[inline(always)]
    pub fn line(&self, y: u32) -> f64 {
        self.lines[y as usize]
    }

    /// The ray through a sample in world space, unit.
    pub fn world_ray(&self, x: u32, y: u32) -> Vec3<f32> {
        let d = vec3(self.column(x), self.line(y), -1.0);
        let world = self.axes[0] * d.x + self.axes[1] * d.y + self.axes[2] * d.z;
        world.normalize().map(|v| v as f32)
    }
}
