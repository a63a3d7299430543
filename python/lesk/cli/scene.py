"""`lesk scene`: checking scene files."""

from __future__ import annotations

import json as jsonlib
from pathlib import Path
from typing import Annotated

import typer

from lesk.cli._run import Json, emit
from lesk.errors import ParameterError, nearest
from lesk.scene import load, schema

ACTIONS = {"check", "schema"}


def main(
    action: Annotated[str, typer.Argument(help="`check` or `schema`.")],
    file: Annotated[Path | None, typer.Argument(help="The scene file to check.")] = None,
    json: Json = False,
) -> None:
    """Check a scene file, or print the JSON Schema of scene files.

    JSON of `check`: `title`, `size` (pixels), `spp`, `ev100`, `objects`, `materials`, `lights`, `notes`, `files`.
    """
    if action == "schema":
        print(jsonlib.dumps(schema(), indent=2))
        return
    if action != "check" or file is None:
        raise ParameterError(f"`lesk scene` takes `check FILE` or `schema`{nearest(action, ACTIONS - {action})}")
    scene = load(file)
    if json:
        emit(
            {
                "title": scene.title,
                "size": scene.size,
                "spp": scene.spp,
                "ev100": scene.ev100,
                "objects": scene.objects,
                "materials": [{"name": name, "model": model} for name, model in scene.materials],
                "lights": scene.light_count,
                "notes": scene.notes,
                "files": [str(path) for path in scene.files],
            }
        )
        return
    width, height = scene.size
    print(f"{file}: fine. {scene.title}")
    print(
        f"{width} x {height} pixels, {len(scene.objects)} objects, {len(scene.materials)} materials, {scene.light_count} lights"
    )
    for note in scene.notes:
        print(f"note: {note}")
