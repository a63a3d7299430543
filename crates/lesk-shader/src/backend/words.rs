//! Words that no local, member or function may be called.

use std::collections::HashSet;
use std::sync::LazyLock;

/// `name`, with an underscore appended where a language has another use for it.
pub fn safe(name: &str) -> String {
    static TAKEN: LazyLock<HashSet<&str>> =
        LazyLock::new(|| FUNCTIONS.split_whitespace().chain(KEYWORDS.split_whitespace()).collect());
    let is_taken = TAKEN.contains(name.to_ascii_lowercase().as_str());
    if is_taken { format!("{name}_") } else { name.to_owned() }
}

/// Functions and types that the exported code uses, and their neighbours.
const FUNCTIONS: &str = "
    abs acos asfloat asin asint asuint atan atan2 bitcast ceil clamp cos cosh cross degrees distance dot exp exp2 exp10
    f32 faceforward floor fma fmod frac fract frexp i32 inversesqrt isinf isnan ldexp length lerp log log10 log2 mad main
    max metal min mix mod modf normalize pow powr radians rcp reflect refract rint round rsqrt saturate select sign sin
    sincos sinh smoothstep sqrt step tan tanh targets texture transpose trunc u32 vec3";

/// Keywords of the target languages.
const KEYWORDS: &str = "
    active alias asm attribute auto become blend bool break buffer case cast catch cbuffer centroid char class coherent
    column_major common compile const const_assert constant continue continuing default delete device diagnostic discard
    do double else enable enum explicit export extern external false filter final fixed flat float float3 fn for fragment
    friend from get goto groupshared half highp if image impl implements import in inline inout input int interface
    invariant isolate kernel layout let line linear long loop lowp macro match matrix mediump meta mod module move mut
    mutable namespace new nil noinline null of operator out output override package packed params partition pass patch
    pixel point precise precision premerge private protected ptr pub public readonly ref regardless register require
    requires resource restrict return row_major sample sampler self set shared short signed sizeof smooth snorm static
    std string struct subroutine super superp switch target tbuffer technique template this thread threadgroup throw trait
    triangle true try type typedef typename typeof uint uniform union unless unorm unsigned use using var varying vector
    vertex virtual void volatile wgsl where while with workgroup writeonly yield";
