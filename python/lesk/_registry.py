"""The models of the registry, as `lesk models --json` prints them."""

from __future__ import annotations

import json
from typing import Any

from lesk import _lesk
from lesk.errors import ParameterError, nearest, quoted

MODELS: list[dict[str, Any]] = json.loads(_lesk.registry_json())["models"]
"""All models in reading order."""

BY_ID: dict[str, dict[str, Any]] = {info["id"]: info for info in MODELS}
"""The same by name."""


def find(name: str) -> dict[str, Any]:
    """Give the facts of a model."""
    if name not in BY_ID:
        hint = nearest(name, BY_ID) or f"\nhint: the models are {quoted(BY_ID)}"
        raise ParameterError(f"there is no model `{name}`{hint}")
    return BY_ID[name]
