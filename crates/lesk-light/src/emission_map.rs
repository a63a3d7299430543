//! A picture on an emissive mesh.

use crate::environment::rec709;
use lesk_geometry::Mesh;
use lesk_image::Texture;
use lesk_math::Color;
use std::sync::Arc;

/// Places along each side of a triangle at which its mean is read, at most: what lies between them is found by paths
/// that meet the surface, if not by asking the light.
const MOST_PLACES: u32 = 24;

/// A picture that multiplies the luminance of an emissive mesh, by its texture coordinates.
#[derive(Clone, Debug)]
pub struct EmissionMap {
    texture: Arc<Texture>,
    mesh: Arc<Mesh>,
    set: usize,
    uv: [[f32; 3]; 2],
    /// Mean over each triangle.
    means: Vec<Color<f32>>,
}

impl EmissionMap {
    /// A picture on a mesh. `set` names the texture coordinates, 0 or 1; `uv` are the rows of the affine map from them
    /// to those of the picture.
    pub fn new(texture: Arc<Texture>, mesh: Arc<Mesh>, set: usize, uv: [[f32; 3]; 2]) -> Self {
        let mut map = EmissionMap { texture, mesh, set, uv, means: Vec::new() };
        map.means = (0..map.mesh.triangles().len()).map(|i| map.mean_of(i)).collect();
        map
    }

    /// What it lies on.
    pub(crate) fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The mean over a triangle.
    pub(crate) fn mean(&self, triangle: usize) -> Color<f32> {
        self.means[triangle]
    }

    /// The factor at barycentric weights of a triangle's corners; never negative.
    pub(crate) fn at(&self, triangle: usize, weights: [f64; 3]) -> Color<f32> {
        let [u, v] = self.place(triangle, weights);
        rec709(self.texture.rgb([u, v]).map(|x| x.max(0.0)))
    }

    fn place(&self, triangle: usize, weights: [f64; 3]) -> [f32; 2] {
        let [u, v] =
            self.mesh.uv(self.set, triangle, weights).or(self.mesh.uv(0, triangle, weights)).unwrap_or([0.0; 2]);
        self.uv.map(|row| row[0] * u + row[1] * v + row[2])
    }

    /// About one place per texel, in the middles of small triangles of equal area.
    fn mean_of(&self, triangle: usize) -> Color<f32> {
        let (w, h) = self.texture.size();
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| self.place(triangle, c));
        let apart = |a: [f32; 2], b: [f32; 2]| ((a[0] - b[0]) * w as f32).hypot((a[1] - b[1]) * h as f32);
        let longest =
            apart(corners[0], corners[1]).max(apart(corners[1], corners[2])).max(apart(corners[2], corners[0]));
        // as: a huge or NaN distance saturates
        let n = (longest.ceil() as u32).clamp(1, MOST_PLACES);
        let mut sum = Color::BLACK;
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            let mut add = |third: f64| {
                let (v, w) = ((f64::from(i) + third) / f64::from(n), (f64::from(j) + third) / f64::from(n));
                sum = sum + self.at(triangle, [1.0 - v - w, v, w]);
            };
            add(1.0 / 3.0);
            if i + j + 1 < n {
                add(2.0 / 3.0);
            }
        }
        sum / (n * n) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Area, Light, Lights, Receiver};
    use lesk_geometry::Transform;
    use lesk_image::texture::{Interpolation, Role, Wrap};
    use lesk_image::{Image, Transfer};
    use lesk_math::{Vec3, vec3};

    const STRAIGHT: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// The square of side 2 with a picture of 2 x 2 texels: 0, 1 above 2, 3, without blending.
    fn square() -> EmissionMap {
        let image = Image::from_fn(2, 2, Transfer::Linear, |x, y| [(2 * y + x) as f32; 3]).unwrap();
        let texture = Texture::new(image, Role::Color, [Wrap::Clamp; 2], Interpolation::Nearest);
        let mesh = Arc::new(lesk_geometry::rectangle());
        EmissionMap::new(Arc::new(texture), mesh, 0, STRAIGHT)
    }

    fn light() -> Area {
        Area::mapped(square(), &Transform::IDENTITY, Color::splat(10.0), false).unwrap()
    }

    #[test]
    fn texels_lie_where_their_coordinates_say() {
        let light = light();
        // v runs upward: the first row of the picture is at +y
        for (x, y, expected) in [(-0.5, 0.5, 0.0), (0.5, 0.5, 1.0), (-0.5, -0.5, 2.0), (0.5, -0.6, 3.0)] {
            let prim = u32::from(y > x);
            let value = light.radiance(prim, vec3(x, y, 0.0), Vec3::Z, Vec3::Z).luminance();
            assert!((value - 10.0 * expected).abs() < 1e-4, "{x} {y}: {value}");
        }
    }

    #[test]
    fn the_flux_is_that_of_the_mean_texel() {
        // pi L A of the mean 1.5 over 4 m2; every triangle has half of the middle texels
        let expected = std::f32::consts::PI * 10.0 * 1.5 * 4.0;
        assert!((light().flux() / expected - 1.0).abs() < 0.05, "{} {expected}", light().flux());
    }

    #[test]
    fn asking_a_textured_light_gives_the_illuminance_of_its_four_squares() {
        let lights = Lights::new(vec![Light::Area(light())]).unwrap();
        let at = Receiver::opaque(vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0));
        let n = 200;
        let mut sum = 0.0f64;
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let u = [i, j].map(|k| (k as f32 + 0.5) / n as f32);
            // the third number picks the triangle: golden-ratio steps
            let pick = ((i * n + j) as f64 * 0.618_033_988_749_894_9).fract() as f32;
            if let Some(s) = lights.sample(&at, pick, u) {
                sum += f64::from(s.value.luminance() * s.wi.z.abs() / s.pdf);
            }
        }
        let mean = sum / f64::from(n * n);
        // by symmetry every square sends a quarter of what the whole of luminance 10 sends: pi L F with the form factor
        // of a parallel square of side 2 at distance 1 below its centre, 4 * 1/(2 pi) * 2 * atan(1/sqrt 2)/sqrt 2
        let form = 4.0 / std::f64::consts::PI * (0.5f64.sqrt()) * (0.5f64.sqrt()).atan();
        let expected = std::f64::consts::PI * 10.0 * form * 1.5;
        assert!((mean / expected - 1.0).abs() < 0.01, "{mean} {expected}");
    }
}
