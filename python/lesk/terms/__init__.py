"""The parts of models, one function per published formula, over arrays.

- `ndf`: distributions of facet normals D, and how to sample them.
- `masking`: masking and shadowing G.
- `fresnel`: reflectance of smooth boundaries F.
- `diffuse`, `lobe`: other parts that several models have.

The modules are generated from the Rust sources by `cargo xtask codegen`; the functions run the same code as the models.
Arguments broadcast; float32 gives float32, anything else float64.

>>> from lesk.terms import fresnel
>>> fresnel.schlick(0.04, 1.0).round(6).tolist()
[0.04, 0.04, 0.04]
>>> round(float(fresnel.dielectric(1.5, 1.0)), 6)
0.04
"""

from lesk.terms import diffuse, fresnel, lobe, masking, ndf

__all__ = ["diffuse", "fresnel", "lobe", "masking", "ndf"]
