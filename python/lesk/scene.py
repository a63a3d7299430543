"""Scene files: what they may hold, and whether one is right."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from lesk._lesk import Scene, scene_schema

__all__ = ["Scene", "load", "parse", "schema"]


def schema() -> dict[str, Any]:
    """Give the JSON Schema of scene files."""
    return dict(json.loads(scene_schema()))


def load(path: str | Path) -> Scene:
    """Read a scene file and everything that it names.

    Parameters
    ----------
    path : path-like
        A TOML file.

    Returns
    -------
    Scene
        For `lesk.render`; `.size`, `.materials`, `.objects`, `.notes` say what it is.

    Raises
    ------
    SceneError
        With all faults of the file: line, what was given, what is accepted.
    """
    return Scene.load(Path(path))


def parse(text: str, folder: str | Path = ".") -> Scene:
    """Read a scene from text; names of files start at `folder`."""
    return Scene.parse(text, Path(folder))
