//! The registry: finds models by name, and compiles each one into all its forms.

use crate::scatter::{Compiled, Scatter};

/// The models, in reading order.
pub fn all() -> impl ExactSizeIterator<Item = &'static dyn Scatter> {
    crate::models::LIST.iter().map(|model| model as &'static dyn Scatter)
}

/// The model with this id.
pub fn find(id: &str) -> Option<&'static dyn Scatter> {
    all().find(|model| model.id() == id)
}

/// The list entry type.
pub(crate) type Entry = &'static Compiled;

/// Turns the list of models into modules, instantiations and the registry. Each model's instantiations are plain
/// functions of a module of its own, so that the compiler gives them a codegen unit of their own: editing one model
/// recompiles that model.
macro_rules! registry {
    ($($id:ident: $Type:ident,)*) => {
        $(pub mod $id;)*
        mod compiled {
            $(pub mod $id {
                crate::registry::instantiate!($id, $Type);
            })*
        }
        pub(crate) static LIST: &[crate::registry::Entry] = &[$(&compiled::$id::COMPILED),*];
    };
}
pub(crate) use registry;

macro_rules! methods {
    ($R:ty, $Type:ident, $MODEL:expr) => {{
        type M = $Type<$R>;
        type V = lesk_math::Vec3<$R>;
        fn model(p: &[$R]) -> M {
            <M as crate::params::Params<$R>>::gather(|i| p[i])
        }
        fn eval(p: &[$R], wi: V, wo: V) -> lesk_math::Color<$R> {
            crate::bsdf::eval($MODEL.domain, &model(p), wi, wo)
        }
        fn pdf(p: &[$R], wi: V, wo: V) -> $R {
            crate::bsdf::pdf($MODEL.domain, &model(p), wi, wo)
        }
        fn sample(p: &[$R], wo: V, u: [$R; 3]) -> V {
            crate::bsdf::Bsdf::sample(&model(p), wo, u)
        }
        fn draw(p: &[$R], wo: V, u: [$R; 3]) -> crate::bsdf::Sample<$R> {
            crate::bsdf::draw($MODEL.domain, &model(p), wo, u)
        }
        fn delta(p: &[$R], wo: V) -> Option<[crate::bsdf::Delta<$R>; 2]> {
            crate::bsdf::Bsdf::delta(&model(p), wo)
        }
        crate::scatter::Methods { eval, pdf, sample, draw, delta }
    }};
}
pub(crate) use methods;

macro_rules! kernel_set {
    ($fma:literal, $Lines:ty, $Type:ident, $MODEL:expr $(, $feature:literal)?) => {{
        type M = $Type<lesk_math::Lane<$fma>>;
        use crate::kernels::{Block, Draw, Eval, EvalPdf, Pdf, run_block};
        use crate::target::Target;
        $(#[target_feature(enable = $feature)])?
        unsafe fn eval(block: &Block, out: &mut [Target], streaming: bool) -> u32 {
            run_block::<$fma, $Lines, M, Eval>($MODEL.domain, block, out, streaming)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn pdf(block: &Block, out: &mut [Target], streaming: bool) -> u32 {
            run_block::<$fma, $Lines, M, Pdf>($MODEL.domain, block, out, streaming)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn eval_pdf(block: &Block, out: &mut [Target], streaming: bool) -> u32 {
            run_block::<$fma, $Lines, M, EvalPdf>($MODEL.domain, block, out, streaming)
        }
        $(#[target_feature(enable = $feature)])?
        unsafe fn draw(block: &Block, out: &mut [Target], streaming: bool) -> u32 {
            run_block::<$fma, $Lines, M, Draw>($MODEL.domain, block, out, streaming)
        }
        crate::kernels::KernelSet { eval, pdf, eval_pdf, draw }
    }};
}
pub(crate) use kernel_set;

macro_rules! instantiate {
    ($id:ident, $Type:ident) => {
        use crate::models::$id::{MODEL, $Type};
        use crate::registry::{kernel_set, methods};
        use lesk_math::{Color, Dual, Expr, Vec3};

        /// Partial derivatives per pass.
        const CHUNK: usize = 4;

        fn eval_pdf(p: &[f32], wi: Vec3<f32>, wo: Vec3<f32>) -> (Color<f32>, f32) {
            let model = <$Type<f32> as crate::params::Params<f32>>::gather(|i| p[i]);
            (crate::bsdf::eval(MODEL.domain, &model, wi, wo), crate::bsdf::pdf(MODEL.domain, &model, wi, wo))
        }

        fn gradient(p: &[f64], wi: Vec3<f64>, wo: Vec3<f64>, out: &mut [f64]) -> Color<f64> {
            type D = Dual<f64, CHUNK>;
            let mut f = Color::BLACK;
            for start in (0..p.len()).step_by(CHUNK) {
                let entry = |i: usize| {
                    if i >= start && i < start + CHUNK { D::variable(p[i], i - start) } else { D::constant(p[i]) }
                };
                let model = <$Type<D> as crate::params::Params<D>>::gather(entry);
                let dual = crate::bsdf::eval(MODEL.domain, &model, wi.map(D::constant), wo.map(D::constant));
                for c in 0..lesk_math::CHANNELS {
                    f.0[c] = dual.0[c].v;
                    for j in start..p.len().min(start + CHUNK) {
                        out[c * p.len() + j] = dual.0[c].d[j - start];
                    }
                }
            }
            f
        }

        pub static COMPILED: crate::scatter::Compiled = crate::scatter::Compiled {
            id: stringify!($id),
            model: &MODEL,
            doc: <$Type<f32> as crate::params::Params<f32>>::DOC,
            specs: <$Type<f32> as crate::params::Params<f32>>::SPECS,
            scalar: methods!(f32, $Type, MODEL),
            eval_pdf,
            reference: methods!(f64, $Type, MODEL),
            gradient,
            recorded: methods!(Expr, $Type, MODEL),
            kernels: crate::kernels::Kernels {
                baseline: kernel_set!(false, crate::kernels::Plain, $Type, MODEL),
                #[cfg(target_arch = "x86_64")]
                avx2: kernel_set!(true, crate::kernels::Avx2, $Type, MODEL, "avx2,fma"),
                #[cfg(target_arch = "x86_64")]
                avx512: kernel_set!(
                    true,
                    crate::kernels::Avx512,
                    $Type,
                    MODEL,
                    "avx512f,avx512vl,avx512bw,avx512dq,avx2,fma"
                ),
            },
        };
    };
}
pub(crate) use instantiate;
