"""`lesk demo`: a picture, the plots of its models, their checks, and a page that shows all of it."""

from __future__ import annotations

import sys
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk.cli._run import Json, emit
from lesk.errors import RenderInterrupted

SECONDS = 60.0
"""How long the picture takes; `--quick` takes a tenth."""


def main(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder of the page.")] = Path("lesk-demo"),
    quick: Annotated[bool, typer.Option("--quick", help="A tenth of the time, and fewer checks.")] = False,
    threads: Annotated[int | None, typer.Option(help="Threads; else one per core.")] = None,
    json: Json = False,
) -> int:
    """Render the demo scene and write a page with the picture, plots and checks of its models.

    JSON: `page`, `picture`, `ended`, `seconds`, `relative_error`, `passed`.
    """
    from lesk._demo_page import write
    from lesk._render import render
    from lesk.scene import parse

    output.mkdir(parents=True, exist_ok=True)
    scene = parse(files("lesk").joinpath("data", "demo.toml").read_text(encoding="utf-8"))
    say("rendering")
    try:
        picture = render(scene, time=SECONDS / 10 if quick else SECONDS, threads=threads, progress=_bar())
    except RenderInterrupted as interrupted:
        interrupted.render.save(output / "picture.png")
        say(f"interrupted; what was done until then is in {output / 'picture.png'}")
        return 130
    finally:
        _close()
    for ending in ("exr", "png"):
        picture.save(output / f"picture.{ending}")
    models = list(dict.fromkeys(model for _, model in scene.materials))
    say(f"picture done after {picture.seconds:.0f} s; plots and checks of {len(models)} models")
    passed = write(output, picture, scene, models, quick=quick, say=say)
    page = output / "index.html"
    if json:
        error = picture.relative_error
        facts: dict[str, Any] = {"page": str(page), "picture": str(output / "picture.exr"), "ended": picture.ended}
        emit({**facts, "seconds": picture.seconds, "relative_error": error, "passed": passed})
    else:
        print(page)
    return 0 if passed else 1


_BARS: list[Any] = []


def _bar() -> Any:
    """A bar with the time left, on a terminal."""
    if not sys.stderr.isatty():
        return None
    from lesk.cli.render import Bar

    _BARS.append(Bar())
    return _BARS[-1]


def _close() -> None:
    while _BARS:
        _BARS.pop().close()


def say(text: str) -> None:
    """Tell on standard error what is going on."""
    print(text, file=sys.stderr, flush=True)
