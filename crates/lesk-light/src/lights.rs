//! All lights of a scene, and the choice of one.

use crate::error::LightError;
use crate::light::Light;
use crate::sample::{LightSample, Receiver};
use crate::tree::{LightTree, MAX_LIGHTS};
use lesk_geometry::Surface;
use lesk_math::{Color, Vec3};

/// The lights of a scene. Light `i` is the one at position `i` of the list given to [`Lights::new`].
///
/// One light is chosen per sample: each distant light with equal probability, and all others through a
/// [`LightTree`] that counts as one more.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    list: Vec<Light>,
    /// The number in the tree of the first part of each light.
    first_part: Vec<u32>,
    /// Light and part of each number in the tree.
    parts: Vec<(u32, u32)>,
    tree: LightTree,
    infinite: Vec<u32>,
}

impl Lights {
    /// Prepares choosing.
    ///
    /// # Errors
    /// More than 2^24 lights, where each triangle of an emissive mesh counts.
    pub fn new(list: Vec<Light>) -> Result<Self, LightError> {
        let mut lights = Lights { list, ..Lights::default() };
        let mut bounds = Vec::new();
        for (i, light) in lights.list.iter().enumerate() {
            let own = light.bounds();
            if bounds.len() + own.len() > MAX_LIGHTS {
                return Err(LightError::new(format!("scene has more than {MAX_LIGHTS} lights and emissive triangles"))
                    .hint("give emissive meshes fewer triangles"));
            }
            lights.first_part.push(bounds.len() as u32);
            lights.parts.extend((0..own.len() as u32).map(|part| (i as u32, part)));
            bounds.extend(own);
            if light.is_infinite() {
                lights.infinite.push(i as u32);
            }
        }
        lights.tree = LightTree::new(&bounds);
        Ok(lights)
    }

    /// The lights, in the order given.
    pub fn list(&self) -> &[Light] {
        &self.list
    }

    /// Whether there is nothing to choose from.
    pub fn is_empty(&self) -> bool {
        self.tree.is_empty() && self.infinite.is_empty()
    }

    /// The probability of each distant light.
    fn infinite_pmf(&self) -> f32 {
        1.0 / (self.infinite.len() + usize::from(!self.tree.is_empty())).max(1) as f32
    }

    /// Chooses a light with `u` in [0, 1): its number, its part (the triangle of a mesh, else 0) and the probability.
    /// `None` where no light arrives.
    pub fn choose(&self, at: &Receiver, u: f32) -> Option<(u32, u32, f32)> {
        let pmf = self.infinite_pmf();
        let scaled = f64::from(u) * (self.infinite.len() + usize::from(!self.tree.is_empty())) as f64;
        if let Some(&light) = self.infinite.get(scaled as usize) {
            return Some((light, 0, pmf));
        }
        let rest = (scaled - self.infinite.len() as f64).clamp(0.0, 1.0 - f64::EPSILON);
        let (leaf, leaf_pmf) = self.tree.sample(at, rest)?;
        let (light, part) = self.parts[leaf as usize];
        Some((light, part, pmf * leaf_pmf))
    }

    /// The probability with which [`choose`](Self::choose) gives a part of a light.
    pub fn pmf(&self, at: &Receiver, light: u32, part: u32) -> f32 {
        let Some(known) = self.list.get(light as usize) else { return 0.0 };
        if known.is_infinite() {
            return if part == 0 { self.infinite_pmf() } else { 0.0 };
        }
        if part >= self.part_count(light) {
            return 0.0;
        }
        self.infinite_pmf() * self.tree.pmf(at, self.first_part[light as usize] + part)
    }

    /// How many parts a light has: the triangles of a mesh, else 1.
    pub fn part_count(&self, light: u32) -> u32 {
        match self.list.get(light as usize) {
            Some(Light::Area(area)) => area.part_count() as u32,
            known => known.is_some().into(),
        }
    }

    /// Chooses a light with `u_light` and a direction to it with `u`, all in [0, 1); `pdf` includes the choice.
    /// `None` where nothing arrives for these numbers, which counts as a sample of value 0.
    pub fn sample(&self, at: &Receiver, u_light: f32, u: [f32; 2]) -> Option<LightSample> {
        let (light, part, pmf) = self.choose(at, u_light)?;
        let mut sample = self.list[light as usize].sample(part, at, u)?;
        sample.pdf *= pmf;
        sample.light = light;
        (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
    }

    /// The density of [`sample`](Self::sample) in 1/sr for the surface of area light `light` that a ray from the
    /// receiver hit.
    pub fn pdf_surface(&self, at: &Receiver, light: u32, hit: &Surface) -> f32 {
        let Some(known) = self.list.get(light as usize) else { return 0.0 };
        let part = if let Light::Area(area) = known { area.part_of(hit.prim) } else { 0 };
        let pmf = self.pmf(at, light, part);
        if pmf > 0.0 { pmf * known.pdf_surface(at, hit) } else { 0.0 }
    }

    /// Luminance in cd/m² that the surface of light `light` sends into direction `w`.
    pub fn emitted(&self, light: u32, surface: &Surface, w: Vec3<f32>) -> Color<f32> {
        self.list.get(light as usize).map_or(Color::BLACK, |l| l.emitted(surface, w))
    }

    /// For a ray that left the scene in direction `wi`: the luminance of every distant light in cd/m², with the density
    /// of [`sample`](Self::sample) for it in 1/sr. Parallel light is not met this way.
    pub fn escaped(&self, at: &Receiver, wi: Vec3<f32>) -> impl Iterator<Item = (Color<f32>, f32)> {
        let pmf = self.infinite_pmf();
        self.infinite.iter().map(move |&i| {
            let light = &self.list[i as usize];
            (light.background(wi), pmf * light.pdf_direction(at, wi))
        })
    }

    /// Luminance in cd/m² of all distant lights together in direction `wi`.
    pub fn background(&self, wi: Vec3<f32>) -> Color<f32> {
        self.infinite.iter().fold(Color::BLACK, |sum, &i| sum + self.list[i as usize].background(wi))
    }
}
