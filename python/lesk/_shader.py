"""Shader source of a model."""

from __future__ import annotations

from collections.abc import Sequence

from lesk import _lesk
from lesk.errors import ParameterError

LANGUAGES: dict[str, str] = dict(_lesk.shader_languages())
"""The languages with the usual ending of their files."""

MATH = ("builtin", "exact")
"""Whose exponentials and trigonometry the source uses."""


def export(model: str, language: str, *, parts: Sequence[str], math: str, complete: bool) -> str | bytes:
    """Write some functions of a model in a language."""
    if math not in MATH:
        raise ParameterError(f"`math` is `{math}`, but `builtin` and `exact` are accepted")
    return _lesk.shader(model, language, [parts] if isinstance(parts, str) else list(parts), math == "exact", complete)
