//! Prints the source of a model: `cargo run --release -p lesk-shader --example source -- ggx wgsl eval,pdf [complete] [exact]`.

use lesk_shader::{Language, Math, Options, Part, Product, export};
use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [model, language, parts, flags @ ..] = &args[..] else {
        return Err("give a model, a language and parts separated by commas".into());
    };
    let model = lesk_bsdf::registry::find(model).ok_or("no model has this name")?;
    let parts: Result<Vec<Part>, _> = parts.split(',').map(str::parse).collect();
    let given = |flag: &str| flags.iter().any(|f| f == flag);
    let options = Options {
        math: if given("exact") { Math::Exact } else { Math::Builtin },
        product: if given("complete") { Product::Complete } else { Product::Functions },
    };
    let source = export(model, &parts?, language.parse::<Language>()?, options)?;
    std::io::stdout().write_all(source.as_bytes())?;
    Ok(())
}
