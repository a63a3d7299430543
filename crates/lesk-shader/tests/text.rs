//! The exported text: readable, with a header, accepted by naga's own front ends.

use lesk_bsdf::registry;
use lesk_shader::{Error, Language, Math, Options, Part, Product, export};

const FUNCTIONS: Options = Options { math: Math::Builtin, product: Product::Functions };

fn text(model: &str, parts: &[Part], language: Language, options: Options) -> String {
    let model = registry::find(model).unwrap();
    export(model, parts, language, options).unwrap().text().unwrap().to_owned()
}

/// The lines of the function `name`, from its header to its closing brace.
fn body<'t>(text: &'t str, name: &str) -> Vec<&'t str> {
    let mut lines = text.lines().skip_while(|line| line.starts_with("//") || !line.contains(name));
    let mut body: Vec<&str> = lines.by_ref().take_while(|line| *line != "}").collect();
    body.push("}");
    body
}

#[test]
fn ggx_reads_as_if_written_by_hand() {
    let wgsl = text("ggx", &[Part::Eval], Language::Wgsl, FUNCTIONS);
    for line in [
        "fn ggx_eval(wi: vec3<f32>, wo: vec3<f32>, p: GgxParams) -> vec3<f32> {",
        "    if (wi.z < 1e-6 || wo.z < 1e-6) {",
        "    let h = wi + wo;",
    ] {
        assert!(wgsl.lines().any(|l| l == line), "{line}\n{wgsl}");
    }
    // the version written by hand from the equations has 24 lines in its functions
    assert!(body(&wgsl, "ggx_eval").len() <= 20, "{wgsl}");
    let glsl = text("ggx", &[Part::Sample], Language::GlslEs300, FUNCTIONS);
    assert!(glsl.contains("vec3 ggx_sample(vec3 wo, vec3 u, GgxParams p) {"), "{glsl}");
    assert!(glsl.contains("normalize(vec3(p.alpha_x * wo.x, p.alpha_y * wo.y, wo.z))"), "{glsl}");
    assert!(glsl.contains("return reflect(-wo, "), "{glsl}");
}

#[test]
fn no_line_is_longer_than_a_screen_and_no_writer_shows() {
    for model in registry::all() {
        for language in Language::ALL.into_iter().filter(|l| *l != Language::SpirV) {
            let text = text(model.id(), &Part::ALL, language, FUNCTIONS);
            for line in text.lines().filter(|line| !line.starts_with("//")) {
                assert!(line.len() <= 160, "{} characters in {}: {line}", line.len(), model.id());
            }
            for foreign in ["naga", "_e1", "_pad", "void main", "#version", "metal::", "__"] {
                assert!(!text.contains(foreign), "`{foreign}` in\n{text}");
            }
            let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            let placeholder =
                |word: &str| word.strip_prefix('q').and_then(|w| w.strip_suffix('z')?.parse::<u32>().ok());
            assert_eq!(words.filter_map(placeholder).next(), None, "{text}");
        }
    }
}

#[test]
fn the_header_says_where_the_formula_is_from() {
    let text = text("ggx", &[Part::Eval, Part::Pdf], Language::Hlsl, FUNCTIONS);
    let header: Vec<&str> = text.lines().take_while(|line| line.starts_with("//")).collect();
    let header = header.join("\n");
    for fact in
        ["walter2007 (2007)", env!("CARGO_PKG_VERSION"), "alpha_y  0.001 to 1", "1/sr, without the cosine", "ggx_pdf"]
    {
        assert!(header.contains(fact), "`{fact}` in\n{header}");
    }
}

#[test]
fn exports_are_the_same_every_time() {
    for model in registry::all() {
        let once = || text(model.id(), &Part::ALL, Language::Wgsl, FUNCTIONS);
        assert_eq!(once(), once());
    }
}

fn validated(module: &naga::Module) {
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty()).validate(module).unwrap();
}

#[test]
fn wgsl_is_read_back() {
    for model in registry::all() {
        for math in [Math::Builtin, Math::Exact] {
            for product in [Product::Functions, Product::Complete] {
                let text = text(model.id(), &Part::ALL, Language::Wgsl, Options { math, product });
                let module =
                    naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
                validated(&module);
            }
        }
    }
}

#[test]
fn glsl_is_read_back() {
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    for model in registry::all() {
        for language in [Language::Glsl450, Language::GlslEs300] {
            for math in [Math::Builtin, Math::Exact] {
                let functions = text(model.id(), &Part::ALL, language, Options { math, ..FUNCTIONS });
                let text = format!("#version 450\n{functions}\nvoid main() {{}}\n");
                let module = naga::front::glsl::Frontend::default().parse(&options, &text);
                validated(&module.unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text))));
            }
        }
    }
}

#[test]
fn wrong_requests_are_explained() {
    let ggx = registry::find("ggx").unwrap();
    let none = export(ggx, &[], Language::Wgsl, FUNCTIONS).unwrap_err();
    assert!(matches!(none, Error::Parts { .. }) && none.to_string().contains("hint: ask for one or more of `eval`"));
    let twice = export(ggx, &[Part::Pdf, Part::Pdf], Language::Wgsl, FUNCTIONS).unwrap_err();
    assert!(twice.to_string().contains("`pdf`, `pdf`"), "{twice}");
    let unknown = "osl".parse::<Language>().unwrap_err();
    assert!(unknown.to_string().contains("`osl`") && unknown.to_string().contains("`glsl-es`"), "{unknown}");
    for language in Language::ALL {
        assert_eq!(language.name().parse(), Ok(language));
    }
    for part in Part::ALL {
        assert_eq!(part.name().parse(), Ok(part));
    }
}
