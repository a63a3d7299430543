"""`lesk models`: the list of models, or all about one."""

from __future__ import annotations

from typing import Annotated

import typer

from lesk._registry import MODELS, find
from lesk.cli._run import Json, emit


def main(
    name: Annotated[str | None, typer.Argument(help="A model; without it, all are listed.")] = None,
    json: Json = False,
) -> None:
    """List the models, or describe one.

    JSON: `models`, a list with `id`, `title`, `year`, `paper`, `doc`, `domain`, `parameters`, `claims`, `counterexamples`.
    """
    chosen = MODELS if name is None else [find(name)]
    if json:
        emit({"models": chosen})
    elif name is None:
        width = max(len(info["id"]) for info in MODELS)
        for info in MODELS:
            print(f"{info['id']:{width}}  {info['year']}  {info['title']}")
    else:
        describe(chosen[0])


def describe(info: dict) -> None:  # type: ignore[type-arg]
    """Print parameters and claims of a model."""
    print(f"{info['id']}: {info['title']} ({info['paper']})\n\n{info['doc'].strip()}\n\nParameters")
    for spec in info["parameters"]:
        low, high = spec["range"]
        unit = f" {spec['unit']}" if spec["unit"] else ""
        kind = "colour" if spec["kind"] == "color" else "number"
        print(f"  {spec['name']}: {kind}, {low:g} to {high:g}{unit}, default {spec['default']}\n      {spec['doc']}")
    print("\nClaims")
    for claim in info["claims"]:
        print(f"  {claim['property']}" + (f" when {claim['when']}" if claim["when"] else ""))
    for row in info["counterexamples"]:
        print(f"  not {row['property']}: {row['because']}")
