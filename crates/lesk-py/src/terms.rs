//! The parts of models (distributions, masking, Fresnel, ...) over NumPy arrays.

use crate::arrays::{Input, Number, Rows, Source, in_parts, share};
use crate::models::Target;
use crate::value_error;
use lesk_bsdf::terms;
use lesk_math::{Real, Vec3, vec3};
use pyo3::prelude::*;
use serde_json::json;

/// Below this number of rows per thread, splitting costs more than it gains.
const GRAIN: usize = 1 << 13;

/// One function: what it is called and what it takes.
struct Term {
    role: &'static str,
    name: &'static str,
    arguments: &'static [(&'static str, &'static str, usize)],
    returns: (&'static str, usize),
    single: fn(&[&[f32]], &mut [f32]),
    double: fn(&[&[f64]], &mut [f64]),
}

/// A kind of argument or result: a number of components, and the way to and from them.
trait Kind<R> {
    const WIDTH: usize;
    fn read(row: &[R]) -> Self;
    fn write(self, row: &mut [R]);
}

type Scalar<R> = R;
type Direction<R> = Vec3<R>;
type Color<R> = lesk_math::Color<R>;
type Pair<R> = [R; 2];

impl<R: Real> Kind<R> for R {
    const WIDTH: usize = 1;
    fn read(row: &[R]) -> R {
        row[0]
    }
    fn write(self, row: &mut [R]) {
        row[0] = self;
    }
}

impl<R: Real> Kind<R> for Vec3<R> {
    const WIDTH: usize = 3;
    fn read(row: &[R]) -> Self {
        vec3(row[0], row[1], row[2])
    }
    fn write(self, row: &mut [R]) {
        row.copy_from_slice(&self.to_array());
    }
}

impl<R: Real> Kind<R> for Color<R> {
    const WIDTH: usize = lesk_math::CHANNELS;
    fn read(row: &[R]) -> Self {
        lesk_math::Channels(std::array::from_fn(|c| row[c]))
    }
    fn write(self, row: &mut [R]) {
        row.copy_from_slice(&self.0);
    }
}

impl<R: Real> Kind<R> for Pair<R> {
    const WIDTH: usize = 2;
    fn read(row: &[R]) -> Self {
        [row[0], row[1]]
    }
    fn write(self, row: &mut [R]) {
        row.copy_from_slice(&self);
    }
}

macro_rules! terms {
    ($($role:ident::$name:ident($($argument:ident: $kind:ident),+) -> $result:ident;)+) => {
        &[$({
            fn run<R: Real>(rows: &[&[R]], out: &mut [R]) {
                let mut rows = rows.iter();
                $(let $argument = <$kind<R> as Kind<R>>::read(rows.next().expect("one row per argument"));)+
                <$result<R> as Kind<R>>::write(terms::$role::$name($($argument),+), out);
            }
            Term {
                role: stringify!($role),
                name: stringify!($name),
                arguments: &[$((stringify!($argument), stringify!($kind), <$kind<f64> as Kind<f64>>::WIDTH)),+],
                returns: (stringify!($result), <$result<f64> as Kind<f64>>::WIDTH),
                single: run::<f32>,
                double: run::<f64>,
            }
        }),+]
    };
}

/// Every term, in the order of its file; a test compares the list with the files.
static TERMS: &[Term] = terms! {
    ndf::ggx(h: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    ndf::sample_ggx_visible(wo: Direction, alpha_x: Scalar, alpha_y: Scalar, u: Pair) -> Direction;
    ndf::beckmann(h: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    ndf::beckmann_tan2(h: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    ndf::sample_beckmann(alpha_x: Scalar, alpha_y: Scalar, u: Pair) -> Direction;
    ndf::gtr1(h: Direction, alpha: Scalar) -> Scalar;
    ndf::sample_gtr1(alpha: Scalar, u: Pair) -> Direction;
    ndf::sample_cos_power(n: Scalar, u: Pair) -> Direction;
    ndf::sample_v_groove(h: Direction, wo: Direction, u: Scalar) -> Direction;
    masking::smith_ggx_g1(w: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    masking::smith_ggx_half(w: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    masking::smith_ggx_visibility(wi: Direction, wo: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    masking::smith_ggx_visibility_separable(wi: Direction, wo: Direction, alpha_x: Scalar, alpha_y: Scalar) -> Scalar;
    masking::v_groove_g1(w: Direction, h: Direction) -> Scalar;
    masking::v_groove(wi: Direction, wo: Direction, h: Direction) -> Scalar;
    fresnel::schlick(f0: Color, cos_theta: Scalar) -> Color;
    fresnel::schlick_weight(cos_theta: Scalar) -> Scalar;
    fresnel::refracted_normal2(eta: Scalar, cos_theta: Scalar) -> Scalar;
    fresnel::dielectric(eta: Scalar, cos_theta: Scalar) -> Scalar;
    fresnel::conductor(eta: Scalar, k: Scalar, cos_theta: Scalar) -> Scalar;
    diffuse::burley(cos_i: Scalar, cos_o: Scalar, cos_d: Scalar, roughness: Scalar) -> Scalar;
    diffuse::burley_subsurface(cos_i: Scalar, cos_o: Scalar, cos_d: Scalar, roughness: Scalar) -> Scalar;
    lobe::sample_cosine(u: Pair) -> Direction;
    lobe::cos_mirror(wi: Direction, wo: Direction) -> Scalar;
    lobe::cos_power(cos: Scalar, n: Scalar) -> Scalar;
    lobe::sample_phong(wo: Direction, n: Scalar, u: Pair) -> Direction;
    lobe::phong_pdf(wi: Direction, wo: Direction, n: Scalar) -> Scalar;
};

/// Every term with its arguments, as JSON.
#[pyfunction]
pub fn terms_json() -> String {
    let terms = TERMS.iter().map(|term| {
        let arguments = term.arguments.iter();
        let arguments = arguments.map(|(name, kind, width)| json!({ "name": name, "kind": kind, "width": width }));
        json!({
            "role": term.role, "name": term.name, "arguments": arguments.collect::<Vec<_>>(),
            "returns": { "kind": term.returns.0, "width": term.returns.1 },
        })
    });
    json!({ "version": 1, "terms": terms.collect::<Vec<_>>() }).to_string()
}

/// Evaluates a term for n rows of arguments into the flat output.
#[pyfunction]
pub fn term(py: Python<'_>, role: &str, name: &str, arguments: Vec<Source<'_>>, out: Target<'_>) -> PyResult<()> {
    let term = TERMS
        .iter()
        .find(|term| term.role == role && term.name == name)
        .ok_or_else(|| value_error(format!("there is no term `{role}.{name}`")))?;
    match out {
        Target::Single(mut out) => run(py, term, &arguments, out.as_slice_mut().map_err(value_error)?, term.single),
        Target::Double(mut out) => run(py, term, &arguments, out.as_slice_mut().map_err(value_error)?, term.double),
    }
}

fn run<T: Number>(
    py: Python<'_>,
    term: &Term,
    arguments: &[Source<'_>],
    out: &mut [T],
    f: fn(&[&[T]], &mut [T]),
) -> PyResult<()> {
    let width = term.returns.1;
    if arguments.len() != term.arguments.len() || !out.len().is_multiple_of(width) {
        return Err(value_error(format!("{} arguments and rows of {width} are needed", term.arguments.len())));
    }
    let n = out.len() / width;
    let widths = term.arguments.iter().map(|argument| argument.2);
    let inputs: Vec<Input> =
        arguments.iter().zip(widths).map(|(source, width)| Input::new(source, width, n)).collect::<PyResult<_>>()?;
    py.detach(|| {
        in_parts(
            &inputs,
            n,
            share(n, GRAIN),
            |size| out.chunks_mut(size * width).collect(),
            |rows: &Rows<T>, out: &mut [T]| {
                let mut row = Vec::with_capacity(rows.len());
                for (i, out) in out.chunks_exact_mut(width).enumerate() {
                    row.clear();
                    row.extend((0..rows.len()).map(|j| rows.row(j, i)));
                    f(&row, out);
                }
                0
            },
        )
    });
    Ok(())
}
