//! The exported source, judged by glslang and SPIRV-Tools. Where a tool is missing, one line says so; with `CI` set,
//! a missing tool fails.

use lesk_bsdf::registry;
use lesk_shader::{Language, Math, Options, Part, Product, export};
use std::path::{Path, PathBuf};
use std::process::Command;

const FUNCTIONS: Options = Options { math: Math::Builtin, product: Product::Functions };

/// Whether a tool can be run.
fn has(tool: &str) -> bool {
    let found = Command::new(tool).arg("--version").output().is_ok();
    assert!(found || std::env::var_os("CI").is_none(), "{tool} is not installed");
    if !found {
        println!("skipped: {tool} is not installed (packages glslang-tools, spirv-tools)");
    }
    found
}

/// A directory of this test, emptied at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Scratch {
        let path = std::env::temp_dir().join(format!("lesk-shader-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Scratch(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn run(tool: &str, args: &[&str], files: &[PathBuf]) {
    let output = Command::new(tool).args(args).args(files).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{tool} {args:?}: {said}");
}

/// Every model, mathematics and product in one language, as files.
fn all_files(scratch: &Scratch, language: Language, complete: fn(&str) -> String) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for model in registry::all() {
        for (math, tag) in [(Math::Builtin, "builtin"), (Math::Exact, "exact")] {
            for product in [Product::Functions, Product::Complete] {
                let source = export(model, &Part::ALL, language, Options { math, product }).unwrap();
                let name = format!("{}-{tag}-{product:?}.{}", model.id(), language.extension());
                files.push(match source.text() {
                    Some(text) if product == Product::Functions => scratch.write(&name, complete(text)),
                    _ => scratch.write(&name, source.as_bytes()),
                });
            }
        }
    }
    files
}

#[test]
fn glslang_accepts_glsl() {
    if has("glslangValidator") {
        let scratch = Scratch::new("glsl");
        let files = all_files(&scratch, Language::Glsl450, |text| format!("#version 450\n{text}\nvoid main() {{}}\n"));
        run("glslangValidator", &["-S", "frag"], &files);
    }
}

#[test]
fn glslang_accepts_glsl_es() {
    if has("glslangValidator") {
        let scratch = Scratch::new("glsl-es");
        let head = |text: &str| format!("#version 300 es\nprecision highp float;\n{text}\nvoid main() {{}}\n");
        let files = all_files(&scratch, Language::GlslEs300, head);
        run("glslangValidator", &["-S", "frag"], &files);
    }
}

#[test]
fn glslang_accepts_hlsl() {
    if has("glslangValidator") {
        let scratch = Scratch::new("hlsl");
        let main =
            |text: &str| format!("{text}\nfloat4 fragment_main() : SV_Target0 {{ return float4(0, 0, 0, 0); }}\n");
        let files = all_files(&scratch, Language::Hlsl, main);
        let output = scratch.0.join("out.spv");
        for file in files {
            let args = ["-D", "-V", "-S", "frag", "-e", "fragment_main", "-o", output.to_str().unwrap()];
            run("glslangValidator", &args, &[file]);
        }
    }
}

#[test]
fn spirv_val_accepts_spirv() {
    if has("spirv-val") {
        let scratch = Scratch::new("spirv");
        for file in all_files(&scratch, Language::SpirV, str::to_owned) {
            // a module to link is none that Vulkan takes
            let is_complete = file.to_string_lossy().contains("Complete");
            let environment = if is_complete { "vulkan1.1" } else { "spv1.1" };
            run("spirv-val", &["--target-env", environment], &[file]);
        }
    }
}

/// Instructions in the bodies of all functions of a module: what stands between label and end, labels excluded.
fn instructions(path: &Path) -> usize {
    const FUNCTION: u32 = 54;
    const FUNCTION_END: u32 = 56;
    const NO_CODE: [u32; 4] = [55, 59, 246, 248]; // parameter, variable, loop merge, label
    let bytes = std::fs::read(path).unwrap();
    let words: Vec<u32> = bytes.chunks_exact(4).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]])).collect();
    let (mut at, mut inside, mut count) = (5, false, 0);
    while at < words.len() {
        let (code, length) = (words[at] & 0xffff, words[at] >> 16);
        match code {
            FUNCTION => inside = true,
            FUNCTION_END => inside = false,
            _ if inside && !NO_CODE.contains(&code) => count += 1,
            _ => {}
        }
        at += length.max(1) as usize;
    }
    count
}

/// Instructions of a function of GLSL after optimisation, called once from a fragment shader.
fn optimised(scratch: &Scratch, name: &str, functions: &str, params: &str, call: &str) -> usize {
    let text = format!(
        "#version 450\n{functions}\nlayout(location = 0) in vec3 wi;\nlayout(location = 1) in vec3 wo;\n\
         layout(location = 0) out vec4 color;\nlayout(std140, binding = 0) uniform Block {{ {params} p; }};\n\
         void main() {{ color = vec4({call}(wi, wo, p), 1.0); }}\n"
    );
    let source = scratch.write(&format!("{name}.frag"), text);
    let (raw, small) = (scratch.0.join(format!("{name}.spv")), scratch.0.join(format!("{name}.opt.spv")));
    run("glslangValidator", &["-V", "-S", "frag", "-o", raw.to_str().unwrap()], &[source]);
    run("spirv-opt", &["-O", "-o", small.to_str().unwrap()], &[raw]);
    instructions(&small)
}

#[test]
fn exported_ggx_is_as_short_as_by_hand() {
    if has("glslangValidator") && has("spirv-opt") {
        let scratch = Scratch::new("by-hand");
        let by_hand = include_str!("assets/ggx_by_hand.glsl");
        let by_hand = optimised(&scratch, "by_hand", by_hand, "Ggx", "ggx_by_hand");
        let model = registry::find("ggx").unwrap();
        let source = export(model, &[Part::Eval], Language::Glsl450, FUNCTIONS).unwrap();
        let exported = optimised(&scratch, "exported", source.text().unwrap(), "GgxParams", "ggx_eval");
        println!("instructions of ggx: {exported} exported, {by_hand} by hand");
        assert!(exported as f64 <= 1.25 * by_hand as f64, "{exported} instructions, {by_hand} by hand");
    }
}
