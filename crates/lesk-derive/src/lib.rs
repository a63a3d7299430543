//! `#[derive(Params)]`: the fields of a model's struct become its parameter table, and nothing else.

use proc_macro::TokenStream;
use proc_macro2::TokenStream as Tokens;
use quote::quote;
use syn::{Attribute, Data, DeriveInput, Error, Expr, Field, Fields, Ident, Lit, Result, Type};

/// Derives `Params<R>` for a struct whose fields are `R` or `Color<R>`.
///
/// Each field carries its documentation and `#[param(default = .., range = a..=b, slider = a..=b, scale = "log", unit = "rad")]`.
/// `slider` defaults to `range`, `scale` to linear, `unit` to dimensionless.
#[proc_macro_derive(Params, attributes(param))]
pub fn derive_params(input: TokenStream) -> TokenStream {
    let input = syn::parse_macro_input!(input as DeriveInput);
    expand(&input).unwrap_or_else(|e| e.to_compile_error()).into()
}

fn expand(input: &DeriveInput) -> Result<Tokens> {
    let Data::Struct(data) = &input.data else {
        return Err(Error::new_spanned(input, "`Params` is derived for structs only"));
    };
    let Fields::Named(fields) = &data.fields else {
        return Err(Error::new_spanned(input, "parameters need names"));
    };
    let params: Vec<Param> = fields.named.iter().map(Param::parse).collect::<Result<_>>()?;
    let name = &input.ident;
    let doc = input.attrs.iter().filter_map(doc_line).collect::<Vec<_>>().join("\n");
    let specs = params.iter().map(Param::spec);
    let fields = params.iter().map(|p| &p.name);
    let loads = params.iter().map(Param::load);
    Ok(quote! {
        impl<R: ::lesk_math::Real> crate::params::Params<R> for #name<R> {
            const DOC: &'static str = #doc;
            const SPECS: &'static [crate::params::ParamSpec] = &[#(#specs),*];
            #[inline(always)]
            fn gather(get: impl Fn(usize) -> R) -> Self {
                let mut at = 0;
                #(#loads)*
                let _ = at;
                #name { #(#fields),* }
            }
        }
    })
}

/// One field.
struct Param {
    name: Ident,
    doc: String,
    is_color: bool,
    default: Vec<Expr>,
    range: [Expr; 2],
    slider: [Expr; 2],
    log: bool,
    unit: String,
}

impl Param {
    fn parse(field: &Field) -> Result<Param> {
        let name = field.ident.clone().ok_or_else(|| Error::new_spanned(field, "parameters need names"))?;
        let is_color = match &field.ty {
            Type::Path(path) if path.path.is_ident("R") => false,
            Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == "Color") => true,
            other => return Err(Error::new_spanned(other, "a parameter is `R` or `Color<R>`")),
        };
        let doc = field.attrs.iter().filter_map(doc_line).collect::<Vec<_>>().join(" ");
        if doc.is_empty() {
            return Err(Error::new_spanned(field, format!("parameter `{name}` needs a doc comment")));
        }
        let (mut default, mut range, mut slider, mut log, mut unit) = (None, None, None, false, String::new());
        for attr in field.attrs.iter().filter(|a| a.path().is_ident("param")) {
            attr.parse_nested_meta(|meta| {
                let key = meta.path.get_ident().map(Ident::to_string).unwrap_or_default();
                let value: Expr = meta.value()?.parse()?;
                match key.as_str() {
                    "default" => default = Some(elements(value)),
                    "range" => range = Some(bounds(value)?),
                    "slider" => slider = Some(bounds(value)?),
                    "scale" => log = text(&value)? == "log",
                    "unit" => unit = text(&value)?,
                    other => {
                        return Err(meta.error(format!("`{other}` is not one of default, range, slider, scale, unit")));
                    }
                }
                Ok(())
            })?;
        }
        let missing = |what| Error::new_spanned(field, format!("parameter `{name}` needs a {what}"));
        let default = default.ok_or_else(|| missing("default"))?;
        let range = range.ok_or_else(|| missing("range"))?;
        let slider = slider.unwrap_or_else(|| range.clone());
        Ok(Param { doc, is_color, default, range, slider, log, unit, name })
    }

    fn spec(&self) -> Tokens {
        let Param { doc, default, range: [lo, hi], slider: [slo, shi], log, unit, .. } = self;
        let name = self.name.to_string();
        let kind = if self.is_color { quote!(Color) } else { quote!(Scalar) };
        quote! {
            crate::params::ParamSpec {
                name: #name,
                doc: #doc,
                kind: crate::params::Kind::#kind,
                default: &[#(#default as f64),*],
                range: [#lo as f64, #hi as f64],
                slider: [#slo as f64, #shi as f64],
                log: #log,
                unit: #unit,
            }
        }
    }

    fn load(&self) -> Tokens {
        let name = &self.name;
        if !self.is_color {
            return quote! { let #name = get(at); at += 1; };
        }
        quote! {
            let mut channels = [get(at); ::lesk_math::CHANNELS];
            for i in 1..::lesk_math::CHANNELS {
                channels[i] = get(at + i);
            }
            let #name = ::lesk_math::Channels(channels);
            at += ::lesk_math::CHANNELS;
        }
    }
}

fn doc_line(attr: &Attribute) -> Option<String> {
    if !attr.path().is_ident("doc") {
        return None;
    }
    match &attr.meta.require_name_value().ok()?.value {
        Expr::Lit(lit) => match &lit.lit {
            Lit::Str(s) => Some(s.value().trim().to_owned()),
            _ => None,
        },
        _ => None,
    }
}

/// `[a, b, c]` or a single value.
fn elements(value: Expr) -> Vec<Expr> {
    match value {
        Expr::Array(array) => array.elems.into_iter().collect(),
        single => vec![single],
    }
}

fn bounds(value: Expr) -> Result<[Expr; 2]> {
    if let Expr::Range(range) = &value
        && let (Some(lo), Some(hi)) = (&range.start, &range.end)
    {
        return Ok([(**lo).clone(), (**hi).clone()]);
    }
    Err(Error::new_spanned(value, "expected `a..=b`"))
}

fn text(value: &Expr) -> Result<String> {
    if let Expr::Lit(lit) = value
        && let Lit::Str(s) = &lit.lit
    {
        return Ok(s.value());
    }
    Err(Error::new_spanned(value, "expected a string"))
}
