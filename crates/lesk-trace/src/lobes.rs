//! The vertices of a wave, sorted by model: rows of numbers for the loops over arrays.

use crate::wave::WAVE;
use lesk_bsdf::Scatter;
use lesk_bsdf::batch::{Rows, draw_rows, eval_pdf_rows};
use lesk_bsdf::kernels::{DRAW_OUTPUTS, EVAL_PDF_OUTPUTS};
use lesk_math::{CHANNELS, Channels, Color, Isa, Vec3, vec3};
use lesk_scene::{MAX_PARAMS, Material};

/// Loops run over a multiple of this many directions, which fills the widest registers.
const LANES: usize = 16;

/// The vertices of each model.
pub(crate) struct Lobes {
    models: Vec<Lobe>,
    /// The place in `models` of each material's model.
    of: Vec<usize>,
}

/// The vertices of one model, each in a lane.
pub(crate) struct Lobe {
    model: &'static dyn Scatter,
    isa: Isa,
    len: usize,
    params: Vec<Vec<f32>>,
    wo: [Vec<f32>; 3],
    /// The direction to a light, or random numbers.
    first: [Vec<f32>; 3],
    out: [Vec<f32>; DRAW_OUTPUTS],
}

impl Lobes {
    pub fn new(materials: &[Material]) -> Self {
        let mut models: Vec<Lobe> = Vec::new();
        let place = |material: &Material| {
            let id = material.model().id();
            models.iter().position(|lobe| lobe.model.id() == id).unwrap_or_else(|| {
                models.push(Lobe::new(material.model()));
                models.len() - 1
            })
        };
        let of = materials.iter().map(place).collect();
        Lobes { models, of }
    }

    pub fn clear(&mut self) {
        self.models.iter_mut().for_each(|lobe| lobe.len = 0);
    }

    /// Adds a vertex with the number of its material and its parameters; gives its lane.
    #[inline]
    pub fn push(&mut self, material: u32, wo: Vec3<f32>, params: &[f32]) -> u32 {
        self.of(material).push(wo, params)
    }

    /// The vertices that share the model of a material.
    #[inline]
    pub fn of(&mut self, material: u32) -> &mut Lobe {
        &mut self.models[self.of[material as usize]]
    }

    /// f and density for the directions in all lanes.
    pub fn eval(&mut self) {
        self.models.iter_mut().for_each(Lobe::eval);
    }

    /// Directions for all lanes.
    pub fn draw(&mut self) {
        self.models.iter_mut().for_each(Lobe::draw);
    }
}

impl Lobe {
    fn new(model: &'static dyn Scatter) -> Self {
        let mut lobe = Lobe {
            model,
            isa: Isa::current(),
            len: 0,
            params: vec![Vec::new(); model.param_count()],
            wo: Default::default(),
            first: Default::default(),
            out: Default::default(),
        };
        lobe.reserve(WAVE);
        lobe
    }

    /// Makes room in all rows.
    fn reserve(&mut self, n: usize) {
        let Lobe { params, wo, first, out, .. } = self;
        params.iter_mut().chain(wo).chain(first).chain(out).for_each(|row| row.resize(n, 0.0));
    }

    #[inline]
    fn push(&mut self, wo: Vec3<f32>, params: &[f32]) -> u32 {
        let lane = self.len;
        if lane == self.wo[0].len() {
            self.reserve(2 * lane);
        }
        self.len += 1;
        set(&mut self.wo, lane, wo);
        for (row, value) in self.params.iter_mut().zip(params) {
            row[lane] = *value;
        }
        lane as u32
    }

    /// The first argument of the coming loop: a direction or three random numbers.
    #[inline]
    pub fn set_first(&mut self, lane: u32, first: Vec3<f32>) {
        set(&mut self.first, lane as usize, first);
    }

    fn eval(&mut self) {
        let n = self.lanes();
        let mut params = [&[][..]; MAX_PARAMS];
        let rows = rows(&self.params, &self.first, &self.wo, &mut params);
        if let Some(out) = self.out.first_chunk_mut::<EVAL_PDF_OUTPUTS>() {
            eval_pdf_rows(self.model, self.isa, rows, out.each_mut().map(|row| &mut row[..n]));
        }
    }

    /// f and the density of drawing the direction, both in 1/sr.
    #[inline]
    pub fn f_and_pdf(&self, lane: u32) -> (Color<f32>, f32) {
        let f = Channels(std::array::from_fn(|c| self.out[c][lane as usize]));
        (f, self.out[CHANNELS][lane as usize])
    }

    fn draw(&mut self) {
        let n = self.lanes();
        let mut params = [&[][..]; MAX_PARAMS];
        let rows = rows(&self.params, &self.first, &self.wo, &mut params);
        draw_rows(self.model, self.isa, rows, self.out.each_mut().map(|row| &mut row[..n]));
    }

    /// The direction that was drawn, in the frame of the vertex.
    #[inline]
    pub fn drawn_wi(&self, lane: u32) -> Vec3<f32> {
        let at = |output: usize| self.out[output][lane as usize];
        vec3(at(0), at(1), at(2))
    }

    /// Its weight and density, and whether a delta lobe was taken.
    #[inline]
    pub fn drawn(&self, lane: u32) -> (Color<f32>, f32, bool) {
        let at = |output: usize| self.out[output][lane as usize];
        (Channels(std::array::from_fn(|c| at(3 + c))), at(3 + CHANNELS), at(4 + CHANNELS) > 0.5)
    }

    /// The number of lanes that loops run over.
    fn lanes(&self) -> usize {
        self.len.next_multiple_of(LANES)
    }
}

/// The inputs of a loop.
fn rows<'a>(
    params: &'a [Vec<f32>],
    first: &'a [Vec<f32>; 3],
    wo: &'a [Vec<f32>; 3],
    table: &'a mut [&'a [f32]; MAX_PARAMS],
) -> Rows<'a> {
    table.iter_mut().zip(params).for_each(|(entry, row)| *entry = row);
    Rows { params: &table[..params.len()], first: first.each_ref().map(|r| &r[..]), wo: wo.each_ref().map(|r| &r[..]) }
}

#[inline]
fn set(rows: &mut [Vec<f32>; 3], lane: usize, v: Vec3<f32>) {
    for (row, value) in rows.iter_mut().zip(v.to_array()) {
        row[lane] = value;
    }
}
