"""The parts of models against closed forms, and the generated files against their sources."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk._term import TERMS
from lesk.terms import fresnel, masking, ndf

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "crates" / "lesk-bsdf" / "src" / "terms"

# the geometry of facets, and other spellings of terms for the arguments that models have at hand
NOT_TERMS = {"facet", "dielectric_between", "schlick_complement", "share"}


def test_schlick_at_normal_incidence_is_f0():
    assert fresnel.schlick([0.1, 0.5, 0.9], 1.0).tolist() == [0.1, 0.5, 0.9]


def test_fresnel_of_glass_and_metal_at_45_degrees():
    # at 45 degrees the parallel reflectance is the square of the perpendicular one
    cos, root = np.sqrt(0.5), np.sqrt(1.5**2 - 0.5)
    perpendicular = ((cos - root) / (cos + root)) ** 2
    assert float(fresnel.dielectric(1.5, cos)) == pytest.approx((perpendicular + perpendicular**2) / 2, rel=1e-14)
    # the exact equations in double precision, computed independently
    assert float(fresnel.conductor(0.2, 3.9, cos)) == pytest.approx(0.9500431802, rel=1e-9)


def test_total_internal_reflection_is_total():
    assert float(fresnel.dielectric(1 / 1.5, np.cos(np.radians(45)))) == 1.0


@pytest.mark.parametrize("distribution", [ndf.ggx, ndf.beckmann])
def test_projected_area_of_facets_is_one(distribution):
    # midpoints in the squared sine and the azimuth: the error falls with the square of the step
    s, phi = np.meshgrid((np.arange(4000) + 0.5) / 4000, (np.arange(64) + 0.5) / 64 * 2 * np.pi)
    sin = np.sqrt(s)
    h = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.sqrt(1 - s)], axis=-1)
    assert np.pi * distribution(h, 0.4, 0.6).mean() == pytest.approx(1, abs=1e-4)


def test_masking_at_normal_incidence_is_none():
    assert float(masking.smith_ggx_g1([0, 0, 1], 0.3, 0.7)) == 1.0


def test_terms_broadcast_and_keep_float32():
    d = ndf.ggx(np.eye(3, dtype=np.float32), np.float32(0.3), 0.2)
    assert d.shape == (3,) and d.dtype == np.float32
    assert ndf.ggx(np.eye(3)[:, None], np.linspace(0.1, 1, 4), 0.2).shape == (3, 4)


def test_wrong_shapes_are_explained():
    with pytest.raises(lesk.ParameterError, match=r"`h` has shape \(2,\), but \(..., 3\)"):
        ndf.ggx([0, 1], 0.1, 0.1)


def test_every_public_function_of_the_sources_is_a_term():
    if not SOURCES.is_dir():
        pytest.skip("the Rust sources are not here")
    for path in sorted(SOURCES.glob("*.rs")):
        if path.stem in NOT_TERMS | {"mod"}:
            continue
        found = set(re.findall(r"^pub fn (\w+)<", path.read_text(), re.MULTILINE))
        listed = {name for role, name in TERMS if role == path.stem}
        assert listed <= found, path.stem
        assert found - listed <= NOT_TERMS, path.stem


def test_generated_files_are_up_to_date():
    script = ROOT / "python" / "stubs.py"
    if not script.is_file() or shutil.which("ruff") is None:
        pytest.skip("the script or ruff is not here")
    answer = subprocess.run([sys.executable, "-P", str(script), "--check"], capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stdout + answer.stderr
