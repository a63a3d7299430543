//! What can be asked for: languages, parts, options.

use crate::Error;
use core::str::FromStr;

/// A shading language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// GLSL ES 3.00: WebGL 2.
    GlslEs300,
    /// GLSL 4.50: OpenGL, Vulkan.
    Glsl450,
    /// WebGPU.
    Wgsl,
    /// Direct3D, shader model 5.1.
    Hlsl,
    /// Metal.
    Msl,
    /// Vulkan; the only language that is no text.
    SpirV,
}

impl Language {
    /// All languages, in the order of lists.
    pub const ALL: [Language; 6] =
        [Language::GlslEs300, Language::Glsl450, Language::Wgsl, Language::Hlsl, Language::Msl, Language::SpirV];

    /// The name on the command line: `glsl-es`, `glsl`, `wgsl`, `hlsl`, `msl`, `spirv`.
    pub fn name(self) -> &'static str {
        match self {
            Language::GlslEs300 => "glsl-es",
            Language::Glsl450 => "glsl",
            Language::Wgsl => "wgsl",
            Language::Hlsl => "hlsl",
            Language::Msl => "msl",
            Language::SpirV => "spirv",
        }
    }

    /// The usual ending of a file name, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Language::GlslEs300 | Language::Glsl450 => "frag",
            Language::Wgsl => "wgsl",
            Language::Hlsl => "hlsl",
            Language::Msl => "metal",
            Language::SpirV => "spv",
        }
    }
}

impl FromStr for Language {
    type Err = Error;
    fn from_str(given: &str) -> Result<Language, Error> {
        let known = Language::ALL.into_iter().find(|language| language.name() == given);
        known.ok_or_else(|| Error::UnknownLanguage { given: given.to_owned() })
    }
}

/// A function of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// f(wi, wo) in 1/sr, without the cosine.
    Eval,
    /// The density of `Sample` in 1/sr.
    Pdf,
    /// Draws `wi` of the continuous part.
    Sample,
    /// Draws `wi` of the whole model, delta lobes included, with weight and density.
    Draw,
}

impl Part {
    /// All parts, in the order of lists.
    pub const ALL: [Part; 4] = [Part::Eval, Part::Pdf, Part::Sample, Part::Draw];

    /// The name, which also ends the function's name.
    pub fn name(self) -> &'static str {
        match self {
            Part::Eval => "eval",
            Part::Pdf => "pdf",
            Part::Sample => "sample",
            Part::Draw => "draw",
        }
    }

    /// The function's vector arguments; the parameters follow.
    pub fn arguments(self) -> [&'static str; 2] {
        match self {
            Part::Eval | Part::Pdf => ["wi", "wo"],
            Part::Sample | Part::Draw => ["wo", "u"],
        }
    }
}

impl FromStr for Part {
    type Err = Error;
    fn from_str(given: &str) -> Result<Part, Error> {
        let known = Part::ALL.into_iter().find(|part| part.name() == given);
        known.ok_or_else(|| Error::UnknownPart { given: given.to_owned() })
    }
}

/// Whose exponentials, logarithms and trigonometry the source uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Math {
    /// The target's: short, fast, as accurate as the target.
    #[default]
    Builtin,
    /// Lesk's polynomials: the accuracy of Lesk everywhere.
    Exact,
}

/// What the source is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Product {
    /// Functions to paste into a shader (SPIR-V: a module to link).
    #[default]
    Functions,
    /// A fragment shader that evaluates the functions for directions from textures.
    Complete,
}

/// How to export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Options {
    /// Whose elementary functions to use.
    pub math: Math,
    /// Functions, or a complete shader.
    pub product: Product,
}

/// Exported source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// Text, with a comment on top that says what it is.
    Text(String),
    /// SPIR-V words, little-endian.
    Binary(Vec<u8>),
}

impl Source {
    /// The text, unless it is SPIR-V.
    pub fn text(&self) -> Option<&str> {
        match self {
            Source::Text(text) => Some(text),
            Source::Binary(_) => None,
        }
    }

    /// What goes into a file.
    pub fn as_bytes(&self) -> &[u8] {
        match self {
            Source::Text(text) => text.as_bytes(),
            Source::Binary(bytes) => bytes,
        }
    }
}
