//! A picture on an emissive surface.

mod mesh;
mod shape;

use crate::environment::rec709;
use crate::error::LightError;
use lesk_geometry::{Geometry, Transform};
use lesk_image::Texture;
use lesk_math::{CHANNELS, Channels, Color};
use std::sync::Arc;

pub(crate) use mesh::MeshMap;
pub(crate) use shape::ShapeMap;

/// A picture that multiplies the luminance of an emissive surface, by its texture coordinates.
#[derive(Clone, Debug)]
pub struct EmissionMap {
    picture: Picture,
    carrier: Carrier,
    geometry: Geometry,
    place: Transform,
}

/// What the picture lies on.
#[derive(Clone, Debug)]
pub(crate) enum Carrier {
    Mesh(MeshMap),
    Shape(Box<ShapeMap>),
}

impl EmissionMap {
    /// A picture on a placed geometry. `set` names the texture coordinates of a mesh, 0 or 1; `uv` are the rows of the
    /// affine map from them to those of the picture.
    ///
    /// # Errors
    /// A geometry without area, more memory than there is.
    pub fn new(
        texture: Arc<Texture>,
        geometry: &Geometry,
        world_from_local: &Transform,
        set: usize,
        uv: [[f32; 3]; 2],
    ) -> Result<Self, LightError> {
        let picture = Picture { texture, uv };
        let carrier = match geometry {
            Geometry::Mesh(mesh) => Carrier::Mesh(MeshMap::new(&picture, mesh.clone(), set)),
            _ => Carrier::Shape(Box::new(ShapeMap::new(&picture, geometry, world_from_local)?)),
        };
        Ok(EmissionMap { picture, carrier, geometry: geometry.clone(), place: *world_from_local })
    }

    /// What it lies on, and where that is.
    pub(crate) fn surface(&self) -> (&Geometry, &Transform) {
        (&self.geometry, &self.place)
    }

    pub(crate) fn carrier(&self) -> &Carrier {
        &self.carrier
    }

    /// The factor at texture coordinates; never negative.
    pub(crate) fn at(&self, uv: [f32; 2]) -> Color<f32> {
        self.picture.at(uv)
    }
}

/// A texture, and how texture coordinates become places in it.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    texture: Arc<Texture>,
    uv: [[f32; 3]; 2],
}

impl Picture {
    /// Width and height in texels.
    fn size(&self) -> [u32; 2] {
        let (w, h) = self.texture.size();
        [w, h]
    }

    /// Texels that the unit square of the texture coordinates covers along u and v.
    fn cells(&self) -> [usize; 2] {
        let [w, h] = self.size().map(|n| n as f32);
        // as: a huge or NaN number saturates
        [0, 1].map(|k| (self.uv[0][k].abs() * w).max(self.uv[1][k].abs() * h).ceil() as usize)
    }

    fn place(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        self.uv.map(|row| row[0] * u + row[1] * v + row[2])
    }

    fn at(&self, uv: [f32; 2]) -> Color<f32> {
        rec709(self.texture.rgb(self.place(uv)).map(|x| x.max(0.0)))
    }
}

/// A mean of colours, summed in f64.
#[derive(Default)]
struct Mean {
    sum: [f64; CHANNELS],
    weight: f64,
}

impl Mean {
    fn add(&mut self, value: Color<f32>, weight: f64) {
        (0..CHANNELS).for_each(|c| self.sum[c] += f64::from(value.0[c]) * weight);
        self.weight += weight;
    }

    fn color(&self) -> Color<f32> {
        Channels(self.sum.map(|x| (x / self.weight) as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Area, Light, Lights, Receiver};
    use lesk_geometry::{Geometry, Transform};
    use lesk_image::texture::{Interpolation, Role, Wrap};
    use lesk_image::{Image, Transfer};
    use lesk_math::{Vec3, vec3};

    const STRAIGHT: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// The square of side 2 with a picture of 2 x 2 texels: 0, 1 above 2, 3, without blending.
    fn square() -> EmissionMap {
        let image = Image::from_fn(2, 2, Transfer::Linear, |x, y| [(2 * y + x) as f32; 3]).unwrap();
        let texture = Texture::new(image, Role::Color, [Wrap::Clamp; 2], Interpolation::Nearest);
        let geometry = Geometry::Mesh(Arc::new(lesk_geometry::rectangle()));
        EmissionMap::new(Arc::new(texture), &geometry, &Transform::IDENTITY, 0, STRAIGHT).unwrap()
    }

    fn light() -> Area {
        Area::mapped(square(), Color::splat(10.0), false).unwrap()
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
        // pi L A of the mean 1.5 over 4 m2; 0.01: small triangles that the edges of texels cut
        let expected = std::f32::consts::PI * 10.0 * 1.5 * 4.0;
        assert!((light().flux() / expected - 1.0).abs() < 0.01, "{} {expected}", light().flux());
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
