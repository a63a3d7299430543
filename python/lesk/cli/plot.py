"""`lesk plot`: pictures of models and terms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lesk.cli._run import Json, Settings, emit, parameters, require_folder
from lesk.errors import FileError, ParameterError, nearest

KINDS = ("polar", "lobe3d", "slice", "albedo", "sphere", "term")
ENDINGS = (".png", ".svg")


def main(
    name: Annotated[str, typer.Argument(help="The model; for a term, its role and name, like ndf.ggx.")],
    kind: Annotated[str, typer.Option(help="polar, lobe3d, slice, albedo, sphere or term.")] = "",
    output: Annotated[Path | None, typer.Option("-o", "--output", help="The file: .png or .svg.")] = None,
    set_: Settings = None,
    theta_i: Annotated[float, typer.Option(help="Polar angle of the light, degrees.")] = 45.0,
    plane: Annotated[str, typer.Option(help="Plane of a polar cut: incidence, across, or degrees.")] = "incidence",
    compare: Annotated[list[str] | None, typer.Option(help="Another model in the same plot; may be repeated.")] = None,
    json: Json = False,
) -> None:
    """Draw a model: polar cut, 3D lobe, slice over half and difference angle, albedo, lit sphere; or a term.

    JSON: `output`, `kind`, `name`.
    """
    kind = kind or ("term" if "." in name else "polar")
    if kind not in KINDS:
        raise ParameterError(f"`--kind` is `{kind}`, but {', '.join(KINDS)} are accepted{nearest(kind, KINDS)}")
    output = output or Path(f"{name}-{kind}.png")
    if output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {' and '.join(ENDINGS)} are accepted")
    require_folder(output)
    figure = draw(name, kind, parameters(set_), theta_i, plane, compare or [])
    try:
        figure.savefig(output)
    except OSError as error:
        raise FileError(f"cannot write `{output}`: {(error.strerror or str(error)).lower()}") from None
    if json:
        emit({"output": str(output), "kind": kind, "name": name})
    else:
        print(output)


def draw(name: str, kind: str, values: dict[str, Any], theta_i: float, plane: str, compare: list[str]) -> Any:
    """Make the figure."""
    from lesk import plot
    from lesk.models import create

    if kind == "term":
        return plot.term(name, **values)
    model = create(name, **values)
    if kind in ("polar", "albedo"):
        models = [model, *(create(other) for other in compare)]
        if kind == "albedo":
            return plot.albedo(models)
        return plot.polar(models, theta_i_deg=theta_i, plane=_plane(plane))
    if compare:
        raise ParameterError(f"`--compare` is given, but a plot of kind `{kind}` shows one model")
    if kind == "lobe3d":
        return plot.lobe3d(model, theta_i_deg=theta_i)
    return plot.slice(model) if kind == "slice" else plot.sphere(model)


def _plane(text: str) -> str | float:
    try:
        return float(text)
    except ValueError:
        return text
