"""Mitsuba 3 in the fastest variant that works here."""

from __future__ import annotations

import glob
import os
import re
from typing import Any


def newest_llvm() -> str | None:
    """Path of the newest LLVM of at least 16: 14 is refused, and 15 aborts on environment maps."""
    versions = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib64/libLLVM*.so*"):
        if number := re.search(r"libLLVM(?:-|\.so\.)(\d+)", path):
            versions[int(number[1])] = path
    return versions[max(versions)] if versions and max(versions) >= 16 else None


LLVM = os.environ.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
if LLVM:
    os.environ["DRJIT_LIBLLVM_PATH"] = LLVM

import mitsuba as mi  # noqa: E402  (the variable must be set before)


def start() -> str:
    """Sets the variant and returns its name: llvm_ad_rgb, or scalar_rgb where there is no LLVM of at least 16."""
    variant = "llvm_ad_rgb" if LLVM else "scalar_rgb"
    if not LLVM:
        print("skipped: Mitsuba's llvm variants (no LLVM of at least 16; on Debian: apt-get install libllvm19)")
    mi.set_variant(variant)
    return variant


VARIANT = start()


def rgb(value: Any) -> dict:
    """A colour in Mitsuba's dictionaries."""
    return {"type": "rgb", "value": [float(v) for v in value]}
