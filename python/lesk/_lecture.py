"""The ideas of the lecture *Light & Shading* (Jiří Bittner, CTU in Prague), and where Lesk shows each."""

from __future__ import annotations

from typing import NamedTuple


class Idea(NamedTuple):
    """One idea of the lecture."""

    slide: str
    says: str
    """What the slide says, in a line."""
    figures: tuple[str, ...] = ()
    """Names of `lesk figure`."""
    commands: tuple[str, ...] = ()
    """Commands that show it."""
    open: str = ""
    """What is still to be made; empty where nothing is."""


ILLUMINANCES = (
    ("temporary place", 50.0),
    ("sight important", 100.0),
    ("high demands", 300.0),
)
"""Illuminances that the lecture wants at places of work, lx."""

IDEAS = (
    Idea("Surface appearance", "geometry × light × reflectance", ("appearance",)),
    Idea(
        "Interaction of light and scene",
        "direct, indirect, specular and caustic paths",
        ("light_paths",),
        ("lesk render examples/scenes/light_paths.toml --split direct,indirect,specular,caustic -o paths.exr",),
    ),
    Idea(
        "Radiant flux, photons",
        "Φ = dQ/dt; E = h f; 1 W at 600 nm is 3e18 photons/s",
        commands=('lesk quantity "1 W @ 600 nm" --to photons/s', 'lesk quantity "600 nm" --to J'),
    ),
    Idea(
        "Radiosity, irradiance, intensity, radiance",
        "dΦ/dA, dΦ/dω, d²Φ/(cosθ dA dω); sensors respond to radiance",
        commands=(
            "lesk render examples/scenes/lights_in_all_units.toml -o lights.exr",
            'lesk quantity "500 lx" --to cd/m2 --reflectance 80%',
        ),
    ),
    Idea(
        "Radiometry and photometry",
        "P = K_m ∫ V R dλ",
        commands=(
            "lesk lecture errata k_m",
            'lesk quantity "1 W @ D65" --to lm --km 680 --range 380:770',
            "lesk spectrum D65",
        ),
    ),
    Idea("Table of quantities", "names in English and Czech, symbols, units", commands=("lesk quantity --units",)),
    Idea(
        "The Sun",
        "3.86e26 W at 1.5e11 m: 1365 W/m², 546 W/m² visible",
        ("sun",),
        ('lesk quantity "3.86e26 W" --to W/m2 --at 1.5e11m --bands',),
    ),
    Idea(
        "LED bulb",
        "1100 lm at 1.5 m: 38.9 lx; 50, 100, 300 lx wanted",
        ("led_bulb",),
        ('lesk quantity "1100 lm" --to lx --at 1.5m --demands',),
    ),
    Idea(
        "Light sources",
        "directional, point, spot, area, environment",
        ("light_sources",),
        tuple(
            f"lesk render examples/scenes/lights_{kind}.toml -o {kind}.exr"
            for kind in ("point", "spot", "directional", "area", "environment")
        ),
    ),
    Idea(
        "Light reflection at a surface",
        "ideal diffuse, ideal specular, glossy, retro-reflection, real",
        ("reflection_types",),
    ),
    Idea(
        "BRDF and its properties",
        "f = dL/(L cosθ dω), reciprocal, passive",
        commands=("lesk eval ggx --wi 30,0 --wo 50,140", "lesk check ggx"),
    ),
    Idea("Measuring BRDFs", "goniometers, light drum", open="measured materials"),
    Idea(
        "BRDF visualisation",
        "lobes, cuts, spheres",
        commands=("lesk plot ggx --kind lobe3d -o lobe.png", "lesk plot ggx --kind slice -o slice.png"),
    ),
    Idea(
        "Other scattering models",
        "BSSRDF, BTDF, BSDF, SVBRDF, BTF",
        commands=("lesk plot rough_dielectric -o btdf.png",),
        open="BSSRDF, BTF",
    ),
    Idea("Empirical models", "simple formulas with intuitive dials", commands=("lesk models",)),
    Idea("Phong illumination model", "I = I_A + Σ (I_D + I_S), cos^h β", ("phong_table",), ("lesk models phong",)),
    Idea(
        "Blinn-Phong illumination model",
        "cos^h γ, “use 4x higher h”",
        ("phong_blinn",),
        ("lesk lecture errata four_times_h",),
    ),
    Idea("Examples: Phong", "k_S × k_D in {0, 0.5, 1}², k_A = 0, h = 50", ("phong_table",)),
    Idea("Shininess: Phong", "k_A = 0, k_D = 0.5, k_S = 1; h = 1, 5, 10, 50, 100", ("shininess",)),
    Idea("Practical setting", "k_A + k_D + k_S ≤ 1", ("phong_table",)),
    Idea("Physically plausible Phong model", "k_d/π + k_s (n + 2)/(2π) cosⁿα", commands=("lesk check modified_phong",)),
    Idea("Ward BRDF", "anisotropic Gaussians; satin", ("ward_satin",), ("lesk lecture errata ward",)),
    Idea("Physically based models", "smoother and rougher microfacets", ("microfacets",)),
    Idea("Cook-Torrance BRDF", "f = D F G/(4 cosθi cosθr)", ("cook_torrance",), ("lesk models cook_torrance",)),
    Idea("Normal distribution D", "Beckmann", ("microfacet_terms",), ("lesk plot ndf.beckmann -o d.svg",)),
    Idea("Fresnel term F", "exact and Schlick's approximation", ("fresnel", "microfacet_terms")),
    Idea("F0 examples", "12 dielectrics, 13 metals, linear and texture values", ("f0_table",)),
    Idea("Shadowing and masking G", "V-grooves", ("microfacet_terms",), ("lesk plot masking.v_groove -o g.svg",)),
    Idea("Oren-Nayar BRDF", "A, B; σ = 0, 0.1, 0.3; image, Lambertian, model", ("oren_nayar",)),
    Idea(
        "Current “PBR” models",
        "Disney 2012, GGX, metalness",
        ("metallic_dial",),
        ("lesk models disney_2012", "lesk models metallic_roughness"),
    ),
    Idea(
        "Unity PBR shader",
        "lerp(0.04, albedo, metallic), (1 − 0.04)(1 − metallic)",
        ("metallic_dial",),
        open="a model unity_standard",
    ),
    Idea(
        "pbrt-v3 materials",
        "15 materials",
        open="materials fourier, hair, kdsubsurface, mix, subsurface, translucent, ...",
    ),
    Idea("BRDF models: overview, timeline", "names and years", ("timeline",), ("lesk models",)),
    Idea(
        "Shading in rasterisation",
        "constant, interpolated colours, interpolated normals",
        ("shading_modes", "mach_bands"),
        ("lesk compare-shading examples/scenes/shading.toml -o shading.png",),
    ),
    Idea("Principle of bilinear interpolation", "f_X from f_A, f_B, f_C, f_D by α, β, γ", ("bilinear",)),
    Idea("Computing vertex normals", "analytic; N = (N1 + N2 + N3 + N4)/4", ("vertex_normals",)),
    Idea(
        "Real and auxiliary edges", "stored, or by crease angle; N = (N2 + N3)/2", ("auxiliary_edges", "crease_angle")
    ),
    Idea(
        "Gouraud against Phong",
        "Gouraud misses the maximum; not invariant to rotation",
        ("missed_highlights", "highlight_crossing", "rotating_quad", "shadow_terminator"),
    ),
)
"""All ideas in the order of the slides."""
