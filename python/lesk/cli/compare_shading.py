"""`lesk compare-shading`: three modes of shading and what they approximate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lesk._compare_shading import MODES, TITLES, compare_shading
from lesk.cli._run import Json, crease_angle_of, emit
from lesk.errors import ParameterError


def main(
    scene: Annotated[Path, typer.Argument(help="The scene file.")],
    output: Annotated[Path | None, typer.Option("-o", "--output", help="The figure: .png or .svg.")] = None,
    tessellation: Annotated[int, typer.Option(help="Faces around a curved shape.")] = 24,
    spp: Annotated[int, typer.Option(help="Samples per pixel of the path-traced reference.")] = 64,
    frames: Annotated[int, typer.Option(help="Frames to time; the median counts.")] = 5,
    normals: Annotated[str | None, typer.Option(help="given, analytic, mean, area, angle or max1999.")] = None,
    crease_angle: Annotated[str | None, typer.Option(help="Edges above are real, degrees; or stored.")] = None,
    curve: Annotated[bool, typer.Option("--curve/--no-curve", help="Error against the number of faces.")] = True,
    json: Json = False,
) -> int:
    """Shade a scene flat, by Gouraud and by Phong, and compare with its direct light, path traced.

    JSON: `modes` with counts, `milliseconds`, `error` (root mean square over mean luminance); `curve`.
    """
    if output is not None and output.suffix.lower() not in (".png", ".svg"):
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but .png and .svg are accepted")
    if spp < 1 or frames < 1:
        raise ParameterError(f"`spp` is {spp} and `frames` is {frames}, but 1 or more is accepted")
    found = compare_shading(
        scene,
        tessellation=tessellation,
        spp=spp,
        frames=frames,
        normals=normals,
        crease_angle_deg=crease_angle_of(crease_angle),
        curve=curve,
    )
    if output is not None:
        found.figure().savefig(output, facecolor="white")
    facts = found.facts()
    if json:
        emit({"scene": str(scene), **facts})
        return 0
    print(f"{'':9}{'ms':>9}{'faces':>9}{'vertices':>10}{'samples':>9}{'evaluations':>13}{'error':>9}")
    for mode in MODES:
        one = facts["modes"][mode]
        print(
            f"{TITLES[mode]:9}{one['milliseconds']:9.2f}{one['faces']:9}{one['vertices']:10}{one['samples']:9}"
            f"{one['evaluations']:13}{100 * one['error']:8.3g}%"
        )
    print(f"{'reference':9}{1000 * facts['reference_seconds']:9.0f}  path traced, depth 1, {spp} samples per pixel")
    for warning in facts["modes"]["phong"]["warnings"]:
        print(f"warning: {warning}")
    return 0
