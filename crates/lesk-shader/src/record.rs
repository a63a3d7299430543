//! Recording a part of a model: its scalar graph, its arguments and its results.

use crate::packed::Type;
use crate::{Error, Math, Part};
use lesk_bsdf::Scatter;
use lesk_bsdf::params::ParamSpec;
use lesk_math::expr::{self, Graph};
use lesk_math::{Expr, Vec3, vec3};

/// One recorded function.
pub struct Recording {
    pub graph: Graph,
    /// One per result: name and components.
    pub outputs: Vec<Output>,
    /// What each of [`Graph::inputs`] is.
    pub inputs: Vec<Input>,
    /// Types of the members of the parameter structure.
    pub members: Vec<Type>,
}

/// One result of a recorded function.
pub struct Output {
    pub name: &'static str,
    /// One expression, or three.
    pub components: Vec<Expr>,
}

/// What a scalar input of the graph is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    /// Component `.1` of the vector argument `.0`.
    Argument(u32, u8),
    /// Component `.1` of the parameter `.0`; for a scalar, 0.
    Member(u32, u8),
}

/// The type of a parameter's member.
pub fn member_type(spec: &ParamSpec) -> Type {
    if spec.len() == 3 { Type::Vector } else { Type::Scalar }
}

fn argument(name: &str) -> Vec3<Expr> {
    vec3(expr::input(&format!("{name}.x")), expr::input(&format!("{name}.y")), expr::input(&format!("{name}.z")))
}

/// Records `part` of `model`.
pub fn record(model: &dyn Scatter, part: Part, math: Math) -> Result<Recording, Error> {
    let methods = model.forms().recorded.ok_or(Error::NoFormula { model: model.id() })?;
    let specs = model.specs();
    let (graph, outputs) = expr::record(|| {
        expr::set_exact(math == Math::Exact);
        let [first, second] = part.arguments().map(argument);
        let params: Vec<Expr> = lesk_bsdf::params::flat_names(specs).iter().map(|name| expr::input(name)).collect();
        match part {
            Part::Eval => vec![Output::color("f", (methods.eval)(&params, first, second).0)],
            Part::Pdf => vec![Output::scalar("pdf", (methods.pdf)(&params, first, second))],
            Part::Sample => vec![Output::vector("wi", (methods.sample)(&params, first, second.to_array()))],
            Part::Draw => {
                let sample = (methods.draw)(&params, first, second.to_array());
                vec![
                    Output::vector("wi", sample.wi),
                    Output::color("weight", sample.weight.0),
                    Output::scalar("pdf", sample.pdf),
                    Output::scalar("delta", sample.delta),
                ]
            }
        }
    });
    let arguments = (0..2).flat_map(|v| (0..3).map(move |k| Input::Argument(v, k)));
    let members = specs.iter().enumerate();
    let members = members.flat_map(|(i, spec)| (0..spec.len()).map(move |k| Input::Member(i as u32, k as u8)));
    Ok(Recording {
        graph,
        outputs,
        inputs: arguments.chain(members).collect(),
        members: specs.iter().map(member_type).collect(),
    })
}

impl Output {
    fn scalar(name: &'static str, x: Expr) -> Output {
        Output { name, components: vec![x] }
    }
    fn vector(name: &'static str, v: Vec3<Expr>) -> Output {
        Output { name, components: v.to_array().to_vec() }
    }
    fn color(name: &'static str, channels: [Expr; lesk_math::CHANNELS]) -> Output {
        Output { name, components: channels.to_vec() }
    }
    /// The type of the result.
    pub fn ty(&self) -> Type {
        if self.components.len() == 3 { Type::Vector } else { Type::Scalar }
    }
}
