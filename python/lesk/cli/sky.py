"""`lesk sky`: the cloudless sky and its sun."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk.cli._run import Json, emit, numbers
from lesk.errors import FileError, ParameterError
from lesk.light import HosekSky

ENDINGS = (".png", ".svg")


def main(
    turbidity: Annotated[float, typer.Option(help="1 to 10: 2 is very clear, 3 clear, 6 hazy.")] = 3.0,
    elevation: Annotated[
        str, typer.Option(metavar="DEG[,DEG...]", help="Of the sun; several for several skies.")
    ] = "45",
    ground: Annotated[str, typer.Option(metavar="RHO|R,G,B", help="Reflectance of the ground.")] = "0.2",
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Draw it: .png or .svg.")] = None,
    json: Json = False,
) -> None:
    """Say what a cloudless sky (Hosek and Wilkie 2012, 2013) and its sun give.

    JSON: `skies`, a list of `turbidity`, `elevation_deg`, `illuminance_lx` (horizontal, without the sun),
    `zenith_cd_per_m2`, `sun_illuminance_lx` (perpendicular, the disk alone), `global_illuminance_lx` (horizontal, both),
    `sun_rgb` (linear Rec.709, luminance 1).
    """
    if output is not None and output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {' and '.join(ENDINGS)} are accepted")
    reflectance = numbers(ground, "--ground")
    one = reflectance[0] if len(reflectance) == 1 else reflectance
    skies = [HosekSky(turbidity, elevation_deg=e, ground=one) for e in numbers(elevation, "--elevation")]
    rows = [describe(sky) for sky in skies]
    if output is not None:
        from lesk import plot

        try:
            plot.sky(skies).savefig(output)
        except OSError as error:
            raise FileError(f"cannot write `{output}`: {(error.strerror or str(error)).lower()}") from None
        print(f"{output} written", file=sys.stderr)
    if json:
        emit({"skies": rows})
        return
    print(f"turbidity {turbidity:g}; horizontal illuminance of sky and of both, perpendicular illuminance of the sun")
    print(f"{'elevation':>9}  {'sky':>10}  {'zenith':>12}  {'sun':>11}  {'sky and sun':>11}")
    for row in rows:
        print(
            f"{row['elevation_deg']:>8g}°  {row['illuminance_lx']:>7.0f} lx  {row['zenith_cd_per_m2']:>6.0f} cd/m2"
            f"  {row['sun_illuminance_lx']:>8.0f} lx  {row['global_illuminance_lx']:>8.0f} lx"
        )


def describe(sky: HosekSky) -> dict[str, Any]:
    """Give what `--json` prints of one sky."""
    import numpy as np

    sun = sky.sun_illuminance_lx
    return {
        "turbidity": sky.turbidity,
        "elevation_deg": sky.elevation_deg,
        "illuminance_lx": sky.illuminance_lx,
        "zenith_cd_per_m2": sky.luminance(0, 0),
        "sun_illuminance_lx": sun,
        "global_illuminance_lx": sky.illuminance_lx + sun * float(np.sin(np.radians(sky.elevation_deg))),
        "sun_rgb": (sky.sun_rgb / sun).tolist() if sun > 0 else None,
    }
