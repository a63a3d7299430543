"""`lesk spectrum`: colour, temperature, rendering and efficacy of a light."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lesk import _lesk
from lesk._spectrum import Spectrum, spectrum
from lesk.cli._run import Json, emit
from lesk.errors import FileError, ParameterError

OBSERVERS = ("1931", "1964", "2006-2", "2006-10")
ENDINGS = (".png", ".svg")


def main(
    source: Annotated[
        str | None, typer.Argument(metavar="NAME|FILE", help="Like D65, FL2, blackbody:2856K, lamp.csv.")
    ] = None,
    range_: Annotated[str | None, typer.Option("--range", help="Wavelengths that count as energy: 380:780.")] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Draw it: .png or .svg.")] = None,
    names: Annotated[bool, typer.Option("--names", help="List the named illuminants.")] = False,
    json: Json = False,
) -> None:
    """Say what a light is: chromaticity, colour temperature, Duv, colour rendering, efficacy.

    JSON: `name`, `range_nm` (null for the whole spectrum), `efficacy_lm_per_w`, `scotopic_efficacy_lm_per_w`,
    `photons_per_joule`, `xy` per observer that sees it, `cct_k` and `duv` (null where they have no meaning), `ra` and `r`
    (R1 to R14, or null), `rgb` (linear, Y = 1, per colour space); with `--names` only `names`.
    """
    if names:
        known = _lesk.spectrum_names()
        if json:
            emit({"names": known})
        else:
            print("\n".join(known))
        return
    if source is None:
        raise ParameterError("there is no spectrum\nhint: lesk spectrum D65, or `--names` for a list")
    light = spectrum(source)
    data = describe(light, range_)
    if output is not None:
        draw(light, output)
        data["output"] = str(output)
    if json:
        emit(data)
    else:
        show(data)


def describe(light: Spectrum, range_: str | None) -> dict[str, Any]:
    """What JSON says."""
    if range_ and not light.energy(range_) > 0:
        raise ParameterError(f"`{light.name}` has no light within `{range_}` nm")
    kelvin, duv = light.color_temperature or (None, None)
    seen = {name: light.xyz(name)[1] > 0 for name in OBSERVERS}
    rendering = light.color_rendering
    return {
        "name": light.name,
        "range_nm": [int(nm) for nm in range_.split(":")] if range_ else light.range,
        "efficacy_lm_per_w": light.efficacy(range_),
        "scotopic_efficacy_lm_per_w": light.efficacy(range_, scotopic=True),
        "photons_per_joule": light.photons_per_joule(range_),
        "xy": {name: light.xy(name).tolist() for name in OBSERVERS if seen[name]},
        "cct_k": kelvin,
        "duv": duv,
        "ra": rendering and rendering.ra,
        "r": rendering and list(rendering.r),
        "rgb": {space: light.rgb(space).tolist() for space in _lesk.rgb_spaces() if seen["1931"]},
    }


def show(data: dict[str, Any]) -> None:
    """Print the same for people."""
    range_nm = data["range_nm"]
    over = "whole spectrum" if range_nm is None else f"{range_nm[0]} to {range_nm[1]} nm"
    print(data["name"])
    print(f"  efficacy     {data['efficacy_lm_per_w']:.6g} lm/W ({over}, K_m = 683.002 lm/W)")
    print(f"  scotopic     {data['scotopic_efficacy_lm_per_w']:.6g} lm/W (K'_m = 1700.06 lm/W)")
    print(f"  photons      {data['photons_per_joule'] / 6.02214076e17:.6g} umol/J")
    for name, (x, y) in data["xy"].items():
        print(f"  x, y         {x:.5f}, {y:.5f} (observer {name})")
    if data["cct_k"] is None:
        print("  CCT          none: no black body is near enough (Duv 0.05)")
    else:
        print(f"  CCT          {data['cct_k']:.0f} K, Duv {data['duv']:+.4f}")
    if data["ra"] is not None:
        print(f"  Ra           {data['ra']:.1f}")
        print(f"  R1 to R14    {' '.join(f'{r:.0f}' for r in data['r'])}")
    for space, rgb in data["rgb"].items():
        print(f"  {space:12} {' '.join(f'{v:.5f}' for v in rgb)} (linear, Y = 1)")
    if "output" in data:
        print(f"  drawn in     {data['output']}")


def draw(light: Spectrum, output: Path) -> None:
    """Write the figure."""
    from lesk import plot

    if output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {' and '.join(ENDINGS)} are accepted")
    try:
        plot.spectrum(light).savefig(output)
    except OSError as error:
        raise FileError(f"cannot write `{output}`: {(error.strerror or str(error)).lower()}") from None
