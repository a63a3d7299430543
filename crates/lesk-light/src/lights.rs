//! All lights of a scene, and the choice of one.

use crate::error::LightError;
use crate::far::FarRectangles;
use crate::light::Light;
use crate::sample::{LightSample, Receiver};
use crate::tree::{LightTree, MAX_LIGHTS};
use lesk_geometry::Surface;
use lesk_math::{Color, Vec3};

/// The lights of a scene. Light `i` is the one at position `i` of the list given to [`Lights::new`].
///
/// One light is chosen per sample, in proportion to the illuminance that it is expected to give: of distant lights the
/// most that they can give, of all others together what the root of their [`LightTree`] estimates for the receiver. A
/// quarter of the choices is dealt out evenly, because estimates do not know what stands in the light.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    list: Vec<Light>,
    /// The number in the tree of the first part of each light.
    first_part: Vec<u32>,
    /// Light and part of each number in the tree.
    parts: Vec<(u32, u32)>,
    tree: LightTree,
    infinite: Vec<u32>,
    /// The place in `infinite` of each light that is there, and for each such place the sum of illuminances up to it, lx.
    rank: Vec<u32>,
    sums: Vec<f64>,
}

/// What [`Lights::sample_or_note`] did.
#[derive(Clone, Copy, Debug)]
pub enum Answer {
    /// [`FarRectangles::sample`] will tell.
    Noted,
    /// As [`Lights::sample`].
    Sample(LightSample),
}

/// The share of choices between distant lights and the tree of the others that does not depend on their strength: a weak
/// light that alone is in sight is still chosen with a quarter of its even probability.
const EVEN_SHARE: f64 = 0.25;

impl Lights {
    /// Prepares choosing.
    ///
    /// # Errors
    /// More than 2^24 lights, where each part of an emissive mesh counts.
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
            lights.rank.push(lights.infinite.len() as u32);
            if light.is_infinite() {
                lights.infinite.push(i as u32);
                let before = lights.sums.last().copied().unwrap_or(0.0);
                lights.sums.push(before + f64::from(light.distant_illuminance()));
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

    /// The illuminance that the tree is expected to give, lx, and that together with distant lights.
    #[inline]
    fn expected(&self, at: &Receiver) -> (f64, f64) {
        let near = f64::from(self.tree.illuminance(at).min(f32::MAX));
        (near, near + self.sums.last().copied().unwrap_or(0.0))
    }

    /// The probability of something that is expected to give `lux` of `all`, one of `count`.
    #[inline]
    fn share(lux: f64, all: f64, count: usize) -> f64 {
        EVEN_SHARE / count as f64 + (1.0 - EVEN_SHARE) * lux / all
    }

    /// The probability of the distant light of this rank.
    #[inline]
    fn infinite_pmf(&self, at: &Receiver, rank: usize) -> f32 {
        let (near, all) = self.expected(at);
        let before = if rank == 0 { 0.0 } else { self.sums[rank - 1] };
        let count = self.infinite.len() + usize::from(near > 0.0);
        Self::share(self.sums[rank] - before, all, count) as f32
    }

    /// The probability of the tree of all other lights.
    #[inline]
    fn tree_pmf(&self, at: &Receiver) -> f32 {
        if self.infinite.is_empty() {
            return 1.0;
        }
        let (near, all) = self.expected(at);
        if near > 0.0 { Self::share(near, all, self.infinite.len() + 1) as f32 } else { 0.0 }
    }

    /// Chooses a light with `u` in [0, 1): its number, its part (of a mesh, else 0) and the probability.
    /// `None` where no light arrives.
    pub fn choose(&self, at: &Receiver, u: f32) -> Option<(u32, u32, f32)> {
        let tree_pmf = self.tree_pmf(at);
        let u = f64::from(u);
        let wide = f64::from(tree_pmf);
        if u < wide {
            let (leaf, leaf_pmf) = self.tree.sample(at, u / wide)?;
            let (light, part) = self.parts[leaf as usize];
            return Some((light, part, tree_pmf * leaf_pmf));
        }
        let rank = self.choose_infinite((u - wide) / (1.0 - wide), wide)?;
        Some((self.infinite[rank], 0, self.infinite_pmf(at, rank)))
    }

    /// The rank of a distant light for `u` in [0, 1), where the tree has the probability `tree_pmf`.
    fn choose_infinite(&self, u: f64, tree_pmf: f64) -> Option<usize> {
        let (count, all) = (self.infinite.len(), *self.sums.last()?);
        if count == 1 {
            return Some(0);
        }
        // of all distant lights together, this much is dealt out evenly
        let even = EVEN_SHARE * count as f64 / (count + usize::from(tree_pmf > 0.0)) as f64 / (1.0 - tree_pmf);
        let rank = if u < even {
            (u / even * count as f64) as usize
        } else {
            let lux = (u - even) / (1.0 - even) * all;
            self.sums.partition_point(|&sum| sum <= lux)
        };
        Some(rank.min(count - 1))
    }

    /// The probability with which [`choose`](Self::choose) gives a part of a light.
    pub fn pmf(&self, at: &Receiver, light: u32, part: u32) -> f32 {
        let Some(known) = self.list.get(light as usize) else { return 0.0 };
        if known.is_infinite() {
            return if part == 0 { self.infinite_pmf(at, self.rank[light as usize] as usize) } else { 0.0 };
        }
        if part >= self.part_count(light) {
            return 0.0;
        }
        self.tree_pmf(at) * self.tree.pmf(at, self.first_part[light as usize] + part)
    }

    /// How many parts a light has: the rectangles and other triangles of a mesh, else 1.
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
        self.sample_chosen(light, part, pmf, at, u)
    }

    #[inline]
    fn sample_chosen(&self, light: u32, part: u32, pmf: f32, at: &Receiver, u: [f32; 2]) -> Option<LightSample> {
        let mut sample = self.list[light as usize].sample(part, at, u)?;
        sample.pdf *= pmf;
        sample.light = light;
        (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
    }

    /// As [`sample`](Self::sample), but a rectangle that is seen small is only noted at place `i` of `far`, to be sampled
    /// there together with others.
    #[inline]
    pub fn sample_or_note(
        &self,
        at: &Receiver,
        u_light: f32,
        u: [f32; 2],
        i: usize,
        far: &mut FarRectangles,
    ) -> Option<Answer> {
        let (light, part, pmf) = self.choose(at, u_light)?;
        if let Light::Area(area) = &self.list[light as usize]
            && let Some(rectangle) = area.rectangle(part)
            && rectangle.is_far(at.p)
        {
            far.note(i, at.p, rectangle, area, pmf, u);
            return Some(Answer::Noted);
        }
        self.sample_chosen(light, part, pmf, at, u).map(Answer::Sample)
    }

    /// The density of [`sample`](Self::sample) in 1/sr for the surface of area light `light` that a ray from the
    /// receiver hit.
    pub fn pdf_surface(&self, at: &Receiver, light: u32, hit: &Surface) -> f32 {
        let Some(known) = self.list.get(light as usize) else { return 0.0 };
        let part = if let Light::Area(area) = known { area.part_of(hit.prim) } else { Some(0) };
        let Some(part) = part else { return 0.0 };
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
        self.infinite.iter().enumerate().map(move |(rank, &i)| {
            let (value, pdf) = self.list[i as usize].seen(at, wi);
            (value, if pdf > 0.0 { self.infinite_pmf(at, rank) * pdf } else { 0.0 })
        })
    }

    /// Luminance in cd/m² of all distant lights together in direction `wi`.
    pub fn background(&self, wi: Vec3<f32>) -> Color<f32> {
        self.infinite.iter().fold(Color::BLACK, |sum, &i| sum + self.list[i as usize].background(wi))
    }
}
