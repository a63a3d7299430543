//! Batches give the bits of calls with one direction, wherever their arrays lie and in whatever layout.

mod common;

use common::{Random, model, narrow};
use lesk_bsdf::batch::{self, Column, Target};
use lesk_bsdf::kernels::{DRAW_OUTPUTS, EVAL_PDF_OUTPUTS};
use lesk_bsdf::{Scatter, params, registry};
use lesk_math::{CHANNELS, Isa};

/// Directions that differ; longer batches repeat them. A prime, so that each meets every place of a group.
const PERIOD: usize = 331;

/// Short ones, some around the number of directions in a group and in a block, and one that goes past the caches.
const SIZES: [usize; 9] = [1, 7, 31, 32, 33, 255, 256, 1000, (1 << 18) + 77];

/// Three numbers per direction, in the layouts that the loops read and in one that they do not.
struct Inputs {
    n: usize,
    interleaved: Vec<f32>,
    planes: [Vec<f32>; 3],
    spread: Vec<f32>,
}

#[derive(Clone, Copy, Debug)]
enum Layout {
    Interleaved,
    Planes,
    Spread,
}

impl Inputs {
    fn new(vectors: &[[f32; 3]], n: usize) -> Inputs {
        let all = || vectors.iter().cycle().take(n);
        Inputs {
            n,
            interleaved: all().flatten().copied().collect(),
            planes: [0, 1, 2].map(|c| all().map(|v| v[c]).collect()),
            spread: all().flat_map(|v| [v[0], v[1], v[2], f32::NAN]).collect(),
        }
    }

    fn rows(&self) -> [&[f32]; 3] {
        self.planes.each_ref().map(|plane| &plane[..])
    }

    fn columns(&self, layout: Layout) -> [Column<'_>; 3] {
        match layout {
            Layout::Interleaved => Column::interleaved(&self.interleaved, self.n),
            Layout::Planes => [0, 1, 2].map(|c| Column::contiguous(&self.planes[c])),
            Layout::Spread => [0, 1, 2].map(|c| Column::strided(&self.spread[c..], 4, self.n)),
        }
    }
}

fn vectors(random: &mut Random, model: &dyn Scatter) -> Vec<[f32; 3]> {
    (0..PERIOD).map(|_| random.direction(model.model().domain, 1e-3).map(|x| x as f32).to_array()).collect()
}

/// A place for `n` values that starts `offset` values behind a border of a cache line.
fn place(memory: &mut [f32], offset: usize, n: usize) -> &mut [f32] {
    let start = (64 - memory.as_ptr().addr() % 64) % 64 / size_of::<f32>();
    &mut memory[start + offset..start + offset + n]
}

/// The bits of the outputs of one draw.
fn draw_one(model: &dyn Scatter, isa: Isa, table: &[Column], u: [f32; 3], wo: [f32; 3]) -> [u32; DRAW_OUTPUTS] {
    let mut rows = [[0.0_f32]; DRAW_OUTPUTS];
    let mut targets: Vec<Target> = rows.iter_mut().map(|row| Target::Row(row)).collect();
    let (u, wo) = (Column::interleaved(&u, 1), Column::interleaved(&wo, 1));
    batch::draw(model, isa, table, u, wo, 1, &mut targets);
    rows.map(|row| row[0].to_bits())
}

/// The bits of the channels of one evaluation.
fn eval_one(model: &dyn Scatter, isa: Isa, table: &[Column], wi: [f32; 3], wo: [f32; 3]) -> [u32; CHANNELS] {
    let mut f = [0.0_f32; CHANNELS];
    let (wi, wo) = (Column::interleaved(&wi, 1), Column::interleaved(&wo, 1));
    batch::eval(model, isa, table, wi, wo, 1, &mut [Target::Interleaved(&mut f, CHANNELS)]);
    f.map(f32::to_bits)
}

fn available() -> impl Iterator<Item = Isa> {
    Isa::ALL.into_iter().filter(|isa| isa.is_available())
}

#[test]
fn results_do_not_depend_on_layout_size_or_place() {
    let model = model("ggx");
    let mut random = Random::new(6);
    let values = narrow(&params::defaults(model.specs()));
    let table: Vec<Column> = values.iter().map(Column::uniform).collect();
    let (wi, wo) = (vectors(&mut random, model), vectors(&mut random, model));
    for isa in available() {
        let expected: Vec<_> = wi.iter().zip(&wo).map(|(wi, wo)| eval_one(model, isa, &table, *wi, *wo)).collect();
        for n in SIZES {
            let (wi, wo) = (Inputs::new(&wi, n), Inputs::new(&wo, n));
            let mut memory = vec![0.0; 3 * n + 64];
            for (offset, layout, layout_o) in [
                (0, Layout::Interleaved, Layout::Interleaved),
                (0, Layout::Planes, Layout::Planes),
                (1, Layout::Interleaved, Layout::Planes),
                (4, Layout::Planes, Layout::Spread),
                (5, Layout::Spread, Layout::Interleaved),
            ] {
                let (wi, wo) = (wi.columns(layout), wo.columns(layout_o));
                let what = format!("{} {n} at {offset}, {layout:?} {layout_o:?}", isa.name());
                let f = place(&mut memory, offset, 3 * n);
                let odd = batch::eval(model, isa, &table, wi, wo, n, &mut [Target::Interleaved(f, CHANNELS)]);
                assert_eq!(odd, 0, "{what}");
                for (i, f) in f.chunks_exact(CHANNELS).enumerate() {
                    assert_eq!([0, 1, 2].map(|c| f[c].to_bits()), expected[i % PERIOD], "vectors, {what}, {i}");
                }
                f.fill(f32::NAN);
                let mut rows: Vec<Target> = f.chunks_exact_mut(n).map(Target::Row).collect();
                batch::eval(model, isa, &table, wi, wo, n, &mut rows);
                for (c, row) in f.chunks_exact(n).enumerate() {
                    for (i, f) in row.iter().enumerate() {
                        assert_eq!(f.to_bits(), expected[i % PERIOD][c], "rows, {what}, {i}");
                    }
                }
            }
        }
    }
}

#[test]
fn draws_fill_arrays_of_every_kind() {
    // glass draws of both kinds of lobe: its delta flags differ
    let model = model("dielectric");
    let mut random = Random::new(7);
    let values = narrow(&params::defaults(model.specs()));
    let table: Vec<Column> = values.iter().map(Column::uniform).collect();
    let wo = vectors(&mut random, model);
    let u: Vec<[f32; 3]> = (0..PERIOD).map(|_| random.unit3_f32()).collect();
    for isa in available() {
        let expected: Vec<_> = u.iter().zip(&wo).map(|(u, wo)| draw_one(model, isa, &table, *u, *wo)).collect();
        for n in SIZES {
            let (u, wo) = (Inputs::new(&u, n), Inputs::new(&wo, n));
            let (mut wi, mut weight, mut pdf) = (vec![0.0; 3 * n], vec![0.0; CHANNELS * n], vec![0.0; n]);
            let mut delta = vec![false; n];
            let mut targets = [
                Target::Interleaved(&mut wi, 3),
                Target::Interleaved(&mut weight, CHANNELS),
                Target::Row(&mut pdf),
                Target::Flags(&mut delta),
            ];
            let (u, wo) = (u.columns(Layout::Planes), wo.columns(Layout::Interleaved));
            assert_eq!(batch::draw(model, isa, &table, u, wo, n, &mut targets), 0);
            for i in 0..n {
                let want = expected[i % PERIOD].map(f32::from_bits);
                let got: Vec<f32> =
                    [&wi[3 * i..3 * i + 3], &weight[CHANNELS * i..CHANNELS * (i + 1)], &[pdf[i]]].concat();
                assert_eq!(got, want[..DRAW_OUTPUTS - 1], "{} {n} {i}", isa.name());
                assert_eq!(delta[i], want[DRAW_OUTPUTS - 1] != 0.0, "{} {n} {i}", isa.name());
            }
        }
    }
}

#[test]
fn every_direction_that_is_not_of_unit_length_is_counted() {
    let model = model("lambert");
    let mut random = Random::new(8);
    let values = narrow(&params::defaults(model.specs()));
    let table: Vec<Column> = values.iter().map(Column::uniform).collect();
    for isa in available() {
        for n in [1, 31, 33, 300] {
            let mut all = vectors(&mut random, model);
            let odd = [0, n / 2, n - 1];
            all[odd[0]][0] += 2.0;
            all[odd[1]][1] = f32::NAN;
            all[odd[2]] = [f32::INFINITY, 0.0, 1.0];
            let count = if n == 1 { 1 } else { 3 };
            let (wi, wo) = (Inputs::new(&all, n), Inputs::new(&[[0.0, 0.0, 1.0]], n));
            for layout in [Layout::Interleaved, Layout::Planes, Layout::Spread] {
                let mut pdf = vec![0.0; n];
                let (wi, wo) = (wi.columns(layout), wo.columns(layout));
                let counted = |first, second, out: &mut [f32]| {
                    batch::pdf(model, isa, &table, first, second, n, &mut [Target::Row(out)])
                };
                assert_eq!(counted(wi, wo, &mut pdf), count, "wi, {} {n} {layout:?}", isa.name());
                assert_eq!(counted(wo, wi, &mut pdf), count, "wo, {} {n} {layout:?}", isa.name());
            }
        }
    }
}

#[test]
fn rows_with_parameters_of_their_own_give_the_bits_of_the_batches() {
    let mut random = Random::new(5);
    let n = 37;
    for model in registry::all() {
        let defaults: Vec<f32> = params::defaults(model.specs()).iter().map(|&v| v as f32).collect();
        let table: Vec<Vec<f32>> =
            defaults.iter().map(|&v| (0..n).map(|i| v * (1.0 - 1e-3 * i as f32)).collect()).collect();
        let table: Vec<&[f32]> = table.iter().map(Vec::as_slice).collect();
        let columns: Vec<Column> = table.iter().map(|row| Column::contiguous(row)).collect();
        let [wi, wo] = [(); 2].map(|()| Inputs::new(&vectors(&mut random, model), n));
        let u = Inputs::new(&(0..n).map(|_| random.unit3_f32()).collect::<Vec<_>>(), n);
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let mut out: [Vec<f32>; EVAL_PDF_OUTPUTS] = std::array::from_fn(|_| vec![0.0; n]);
            let input = batch::Rows { params: &table, first: wi.rows(), wo: wo.rows() };
            batch::eval_pdf_rows(model, isa, input, out.each_mut().map(|row| &mut row[..]));
            let mut expected: [Vec<f32>; EVAL_PDF_OUTPUTS] = std::array::from_fn(|_| vec![0.0; n]);
            let (f, pdf) = expected.split_at_mut(CHANNELS);
            let (first, second) = (wi.columns(Layout::Planes), wo.columns(Layout::Planes));
            let mut targets: Vec<Target> = f.iter_mut().map(|row| Target::Row(row)).collect();
            batch::eval(model, isa, &columns, first, second, n, &mut targets);
            batch::pdf(model, isa, &columns, first, second, n, &mut [Target::Row(&mut pdf[0])]);
            assert_eq!(out, expected, "{} {isa:?}", model.id());

            let mut out: [Vec<f32>; DRAW_OUTPUTS] = std::array::from_fn(|_| vec![0.0; n]);
            let input = batch::Rows { params: &table, first: u.rows(), wo: wo.rows() };
            batch::draw_rows(model, isa, input, out.each_mut().map(|row| &mut row[..]));
            let mut expected: [Vec<f32>; DRAW_OUTPUTS] = std::array::from_fn(|_| vec![0.0; n]);
            let mut targets: Vec<Target> = expected.iter_mut().map(|row| Target::Row(row)).collect();
            batch::draw(model, isa, &columns, u.columns(Layout::Planes), second, n, &mut targets);
            assert_eq!(out, expected, "{} {isa:?}", model.id());
        }
    }
}
