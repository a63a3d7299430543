"""`lesk falsecolor`: luminance or illuminance as colours beside a scale."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from lesk import image
from lesk._measure import run, scene_of
from lesk._render import render
from lesk.cli._run import Json, emit, numbers
from lesk.cli.lux import Bar, share
from lesk.errors import FileError, MeasureInterrupted, ParameterError, RenderInterrupted

UNITS = ("cd/m2", "lx")


def main(
    source: Annotated[Path, typer.Argument(help="A scene file, or a linear picture in cd/m2: .exr or .hdr.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture: .png, .svg or .pdf.")],
    unit: Annotated[str, typer.Option(help="cd/m2: luminance; lx: illuminance of surfaces, of scenes only.")] = "cd/m2",
    scale: Annotated[str | None, typer.Option("--range", help="Ends of the scale, LOW,HIGH.")] = None,
    log: Annotated[bool, typer.Option("--log", help="Steps of equal ratio.")] = False,
    spp: Annotated[int | None, typer.Option(help="Samples per pixel of luminances; else what the scene says.")] = None,
    width: Annotated[int, typer.Option(help="Width of a picture of illuminances in pixels.")] = 160,
    error: Annotated[str, typer.Option(help="Relative standard error of illuminances.")] = "10%",
    time: Annotated[float | None, typer.Option(help="Seconds after which sampling stops.")] = None,
    json: Json = False,
) -> int:
    """Show luminance or illuminance in false colours, beside their scale. Ctrl-C keeps what is done.

    JSON: `output`, `unit`, `min`, `mean`, `max`.
    """
    if unit not in UNITS:
        raise ParameterError(f"`--unit` is `{unit}`, but {' and '.join(UNITS)} are accepted")
    if output.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but .png, .svg and .pdf are accepted")
    ends: list[float | None] = list(numbers(scale, "--range")) if scale else [None, None]
    if len(ends) != 2:
        raise ParameterError(f"`--range` is `{scale}`, but two numbers are accepted, like `0,500`")
    title, status = "", 0
    if source.suffix.lower() != ".toml":
        value = picture(source, unit)
    else:
        scene = scene_of(source)
        title = scene.title
        if unit == "lx":
            value, status = illuminances(scene, width, share(error, "--error"), time)
        else:
            value, status = luminances(scene, spp, time)
    from lesk.plot import false_color

    figure = false_color(value, unit, low=ends[0], high=ends[1], log=log, title=title)
    try:
        figure.savefig(output)
    except OSError as failure:
        raise FileError(f"cannot write `{output}`: {(failure.strerror or str(failure)).lower()}") from None
    facts = {"min": float(value.min()), "mean": float(value.mean()), "max": float(value.max())}
    if json:
        emit({"output": str(output), "unit": unit, **facts})
    else:
        listed = ", ".join(f"{name} {number:.4g}" for name, number in facts.items())
        print(f"{output}: {listed} {unit}", file=sys.stderr)
    return status


def luminances(scene: Any, spp: int | None, time: float | None) -> tuple[Any, int]:
    """Render; the status is 130 after Ctrl-C."""
    from lesk.cli.render import Bar as RenderBar

    bar = RenderBar() if sys.stderr.isatty() else None
    try:
        return luminance(render(scene, spp=spp, time=time, progress=bar).rgb), 0
    except RenderInterrupted as stopped:
        return luminance(stopped.render.rgb), 130
    finally:
        if bar is not None:
            bar.close()


def illuminances(scene: Any, width: int, error: float, time: float | None) -> tuple[Any, int]:
    """Measure what every pixel of the scene's camera sees; the status is 130 after Ctrl-C."""
    columns, rows = scene.size
    size = (width, max(1, round(width * rows / columns)))
    wishes: dict[str, Any] = dict.fromkeys(("seed", "max_depth", "threads", "sensors"))
    wishes |= {"error": error, "time": time, "max_samples": 1 << 14, "camera": (*size, True)}
    bar = Bar() if sys.stderr.isatty() else None
    try:
        return run(scene, wishes, bar).sensors[0].value, 0
    except MeasureInterrupted as stopped:
        return stopped.measurement.sensors[0].value, 130
    finally:
        if bar is not None:
            bar.close()


def picture(source: Path, unit: str) -> Any:
    """The luminance of every pixel of a linear picture."""
    if unit != "cd/m2":
        raise ParameterError(
            f"`--unit` is `{unit}`, but a picture holds luminances\nhint: give the scene file for illuminances"
        )
    if source.suffix.lower() not in (".exr", ".hdr"):
        raise ParameterError(f"`{source.name}` ends in `{source.suffix}`, but .toml, .exr and .hdr are accepted")
    pixels = image.read(source)
    return pixels[..., 0].astype(np.float64) if pixels.shape[2] < 3 else luminance(pixels[..., :3])


def luminance(rgb: Any) -> Any:
    """Luminance of linear Rec.709."""
    from lesk.plot._figure import LUMINANCE

    return np.asarray(rgb, np.float64) @ LUMINANCE
