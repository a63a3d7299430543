"""`lesk figure`: the figures of the lecture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lesk.cli._run import Json, emit
from lesk.errors import FileError, ParameterError, nearest

ENDINGS = (".svg", ".png", ".pdf")


def main(
    name: Annotated[str | None, typer.Argument(metavar="ID", help="The figure; without it, all are listed.")] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="The file: .svg, .png or .pdf; of an animation .png, .apng or .gif."),
    ] = None,
    json: Json = False,
) -> None:
    """Make a figure of the lecture, or list them.

    JSON: `figures`, a list with `id`, `title`, `caption`, `animated`; or these of one figure and `output`.
    """
    from lesk.figures import ALL, Animation

    if name is None:
        if output is not None:
            raise ParameterError("`-o` is given without a figure\nhint: `lesk figure` lists them")
        _list(json=json)
        return
    if name not in ALL:
        raise ParameterError(
            f"there is no figure `{name}`{nearest(name, ALL) or f'{chr(10)}hint: `lesk figure` lists them'}"
        )
    figure = ALL[name]
    output = output or Path(f"{name}.png")
    endings = Animation.ENDINGS if figure.animated else ENDINGS
    if output.suffix.lower() not in endings:
        kind = "an animation" if figure.animated else "a figure"
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {kind} accepts {', '.join(endings)}")
    try:
        figure.make().savefig(output)
    except OSError as error:
        raise FileError(f"cannot write `{output}`: {(error.strerror or str(error)).lower()}") from None
    if json:
        emit({"output": str(output), **facts(name)})
    else:
        print(output)


def facts(name: str) -> dict[str, object]:
    """Give what `--json` prints of a figure."""
    from lesk.figures import ALL

    figure = ALL[name]
    return {"id": name, "title": figure.title, "caption": figure.caption, "animated": figure.animated}


def _list(*, json: bool) -> None:
    from lesk.figures import ALL

    if json:
        emit({"figures": [facts(name) for name in ALL]})
        return
    width = max(map(len, ALL))
    for name, figure in ALL.items():
        print(f"{name:{width}}  {figure.title}{' (animation)' if figure.animated else ''}")
