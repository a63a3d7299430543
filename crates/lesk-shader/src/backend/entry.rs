//! The complete shader: a fragment shader whose directions come from textures, one texel per fragment.

use super::lower::{Lowered, add_type};
use crate::packed::Type;
use crate::{Function, Unit};
use naga::{
    AddressSpace, Binding, BuiltIn, EntryPoint, Expression, FunctionArgument, FunctionResult, GlobalVariable, Handle,
    ImageClass, ImageDimension, Literal, ResourceBinding, Scalar, ScalarKind, ShaderStage, Span, Statement,
    StructMember, SwizzleComponent, TypeInner, VectorSize,
};

/// The name of the entry point where the language leaves it to us.
pub(super) const NAME: &str = "fragment_main";

/// The arguments that the functions take, in the order of the textures' bindings.
pub(super) fn arguments(unit: &Unit) -> Vec<&'static str> {
    let used = |name: &&str| unit.functions.iter().any(|f| f.part.arguments().contains(name));
    ["wi", "wo", "u"].into_iter().filter(used).collect()
}

/// The render targets: name and result of each.
pub(super) fn targets(unit: &Unit) -> Vec<String> {
    let parts = |f: &Function| match f.part {
        crate::Part::Draw => vec!["draw_wi_pdf".to_owned(), "draw_weight_delta".to_owned()],
        // `sample` is a keyword of GLSL
        crate::Part::Sample => vec!["sampled".to_owned()],
        part => vec![part.name().to_owned()],
    };
    unit.functions.iter().flat_map(parts).collect()
}

struct Entry<'a> {
    lowered: &'a mut Lowered,
    out: naga::Function,
    from: usize,
}

/// Adds the entry point; returns the names of the textures.
pub(super) fn fragment(lowered: &mut Lowered, unit: &Unit) -> Vec<String> {
    let four = TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::F32 };
    let four = add_type(&mut lowered.module, None, four);
    let result = add_result(lowered, four, &targets(unit));
    let mut entry = Entry { lowered, out: naga::Function::default(), from: 0 };
    let textures = arguments(unit);
    let globals: Vec<Handle<GlobalVariable>> =
        textures.iter().enumerate().map(|(k, name)| entry.add_texture(name, k as u32 + 1)).collect();
    let params = entry.lowered.types.params.map(|ty| entry.add_params(ty));
    let directions = entry.load_directions(four, &globals, &textures);
    let params = params.map(|global| entry.load_params(global));
    let mut values = Vec::new();
    for (k, function) in unit.functions.iter().enumerate() {
        let find = |name: &str| textures.iter().position(|t| *t == name).map(|at| directions[at]);
        let arguments = function.part.arguments().into_iter().filter_map(find).chain(params).collect();
        let call = entry.call(k, arguments);
        entry.targets_of(function, call, four, &mut values);
    }
    entry.finish(result, values);
    textures.iter().map(|name| format!("{name}_map")).collect()
}

fn add_result(lowered: &mut Lowered, four: Handle<naga::Type>, targets: &[String]) -> Handle<naga::Type> {
    let member = |(k, name): (usize, &String)| StructMember {
        name: Some(lowered.names.add(name)),
        ty: four,
        binding: Some(Binding::Location {
            location: k as u32,
            interpolation: None,
            sampling: None,
            blend_src: None,
            per_primitive: false,
        }),
        offset: 16 * k as u32,
    };
    let members: Vec<StructMember> = targets.iter().enumerate().map(member).collect();
    let span = 16 * members.len() as u32;
    let name = lowered.names.add("Targets");
    add_type(&mut lowered.module, Some(name), TypeInner::Struct { members, span })
}

impl Entry<'_> {
    fn global(&mut self, name: &str, space: AddressSpace, ty: Handle<naga::Type>, at: u32) -> Handle<GlobalVariable> {
        let global = GlobalVariable {
            name: Some(self.lowered.names.add(name)),
            space,
            binding: Some(ResourceBinding { group: 0, binding: at }),
            ty,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        self.lowered.module.global_variables.append(global, Span::UNDEFINED)
    }

    fn add_texture(&mut self, argument: &str, at: u32) -> Handle<GlobalVariable> {
        let class = ImageClass::Sampled { kind: ScalarKind::Float, multi: false };
        let image = TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class };
        let ty = add_type(&mut self.lowered.module, None, image);
        self.global(&format!("{argument}_map"), AddressSpace::Handle, ty, at)
    }

    fn add_params(&mut self, ty: Handle<naga::Type>) -> Handle<GlobalVariable> {
        self.global("params", AddressSpace::Uniform, ty, 0)
    }

    fn append(&mut self, expression: Expression) -> Handle<Expression> {
        self.out.expressions.append(expression, Span::UNDEFINED)
    }

    /// For expressions that must not be emitted.
    fn append_bare(&mut self, expression: Expression) -> Handle<Expression> {
        self.emit();
        let value = self.append(expression);
        self.from = self.out.expressions.len();
        value
    }

    fn emit(&mut self) {
        if self.from < self.out.expressions.len() {
            let range = self.out.expressions.range_from(self.from);
            self.out.body.push(Statement::Emit(range), Span::UNDEFINED);
        }
        self.from = self.out.expressions.len();
    }

    fn named(&mut self, value: Handle<Expression>, name: &str) {
        let name = self.lowered.names.add(name);
        self.out.named_expressions.insert(value, name);
    }

    fn load_directions(
        &mut self,
        four: Handle<naga::Type>,
        globals: &[Handle<GlobalVariable>],
        names: &[&str],
    ) -> Vec<Handle<Expression>> {
        let name = Some(self.lowered.names.add("position"));
        let binding = Some(Binding::BuiltIn(BuiltIn::Position { invariant: false }));
        self.out.arguments.push(FunctionArgument { name, ty: four, binding });
        let position = self.append_bare(Expression::FunctionArgument(0));
        let zero = self.append_bare(Expression::Literal(Literal::I32(0)));
        let images: Vec<_> =
            globals.iter().map(|&global| self.append_bare(Expression::GlobalVariable(global))).collect();
        let pattern = [SwizzleComponent::X, SwizzleComponent::Y, SwizzleComponent::Z, SwizzleComponent::W];
        let xy = self.append(Expression::Swizzle { size: VectorSize::Bi, vector: position, pattern });
        let texel = self.append(Expression::As { expr: xy, kind: ScalarKind::Sint, convert: Some(4) });
        self.named(texel, "texel");
        let mut load = |(&image, &name): (&Handle<Expression>, &&str)| {
            let load =
                Expression::ImageLoad { image, coordinate: texel, array_index: None, sample: None, level: Some(zero) };
            let load = self.append(load);
            self.named(load, &format!("{name}_texel"));
            let direction = self.append(Expression::Swizzle { size: VectorSize::Tri, vector: load, pattern });
            self.named(direction, name);
            direction
        };
        images.iter().zip(names).map(&mut load).collect()
    }

    fn load_params(&mut self, global: Handle<GlobalVariable>) -> Handle<Expression> {
        let pointer = self.append_bare(Expression::GlobalVariable(global));
        let load = self.append(Expression::Load { pointer });
        self.named(load, "p");
        load
    }

    fn call(&mut self, k: usize, arguments: Vec<Handle<Expression>>) -> Handle<Expression> {
        let function = self.lowered.functions[k];
        let result = self.append_bare(Expression::CallResult(function));
        self.out.body.push(Statement::Call { function, arguments, result: Some(result) }, Span::UNDEFINED);
        result
    }

    /// What one function contributes to the render targets.
    fn targets_of(
        &mut self,
        function: &Function,
        call: Handle<Expression>,
        four: Handle<naga::Type>,
        out: &mut Vec<Handle<Expression>>,
    ) {
        let zero = self.append_bare(Expression::Literal(Literal::F32(0.0)));
        let member = |k: u32| Expression::AccessIndex { base: call, index: k };
        let padded = |value, ty, last| match ty {
            Type::Vector => vec![value, last],
            _ => vec![value, zero, zero, last],
        };
        let components = match function.results[..] {
            [(_, ty)] => vec![padded(call, ty, zero)],
            _ => {
                let [wi, weight, pdf, delta] = [0, 1, 2, 3].map(|k| self.append(member(k)));
                vec![padded(wi, Type::Vector, pdf), padded(weight, function.results[1].1, delta)]
            }
        };
        out.extend(components.into_iter().map(|components| self.append(Expression::Compose { ty: four, components })));
    }

    fn finish(mut self, result: Handle<naga::Type>, components: Vec<Handle<Expression>>) {
        let value = self.append(Expression::Compose { ty: result, components });
        self.emit();
        self.out.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
        self.out.result = Some(FunctionResult { ty: result, binding: None });
        self.lowered.module.entry_points.push(entry_point(self.out));
    }
}

/// A fragment entry point.
pub(super) fn entry_point(function: naga::Function) -> EntryPoint {
    EntryPoint {
        name: NAME.to_owned(),
        stage: ShaderStage::Fragment,
        early_depth_test: None,
        workgroup_size: [0; 3],
        workgroup_size_overrides: None,
        function,
        mesh_info: None,
        task_payload: None,
        incoming_ray_payload: None,
    }
}
