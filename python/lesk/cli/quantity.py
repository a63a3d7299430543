"""`lesk quantity`: a quantity of light in another unit, with the chain of assumptions."""

from __future__ import annotations

import sys
from dataclasses import asdict
from typing import Annotated, Any

import typer

from lesk import _lesk
from lesk._lecture import ILLUMINANCES
from lesk._quantity import Quantity, quantity
from lesk.cli._run import Json, emit
from lesk.errors import ParameterError

SUN_K = 5778.0
"""Temperature of the black body that stands for the Sun in `--bands`."""
# Bittner, *Light & Shading*: what the lecture says of the Sun's radiation
_LECTURE = (("ultraviolet", 0.1), ("visible", 0.4), ("infrared", 0.5))


def main(
    given: Annotated[str | None, typer.Argument(metavar="QUANTITY", help='Like "1100 lm" or "1 W @ 600 nm".')] = None,
    to: Annotated[str | None, typer.Option(help="A unit, or the name of a quantity.")] = None,
    at: Annotated[str | None, typer.Option(help="Distance from the source: 1.5m.")] = None,
    cone: Annotated[str | None, typer.Option(help="Half-angle of an even cone that holds the light: 30deg.")] = None,
    solid_angle: Annotated[str | None, typer.Option(help="Solid angle of the light: 0.1sr.")] = None,
    area: Annotated[str | None, typer.Option(help="Area that is lit, or that shines: 2m2.")] = None,
    reflectance: Annotated[str | None, typer.Option(help="Of a Lambertian surface: 0.5.")] = None,
    incidence: Annotated[str | None, typer.Option(help="Angle to the normal of the lit surface: 60deg.")] = None,
    time: Annotated[str | None, typer.Option(help="How long a constant light shines: 8h.")] = None,
    width: Annotated[str | None, typer.Option(help="Width of a band, between W/nm and W: 10nm.")] = None,
    efficacy: Annotated[str | None, typer.Option(help="Lumens of a watt: 100lm/W.")] = None,
    spectrum: Annotated[str | None, typer.Option(help="A, D65, FL2, LED-B3, blackbody:2856K, 555nm, lamp.csv.")] = None,
    range_: Annotated[str | None, typer.Option("--range", help="Wavelengths that count as energy: 380:780.")] = None,
    km: Annotated[str | None, typer.Option(help="Another K_m than 683.002 lm/W.")] = None,
    lambertian: Annotated[bool, typer.Option("--lambertian", help="The source is a Lambertian surface.")] = False,
    dome: Annotated[bool, typer.Option("--dome", help="The light comes from an even hemisphere.")] = False,
    scotopic: Annotated[bool, typer.Option("--scotopic", help="Lumens of eyes adapted to the dark.")] = False,
    bands: Annotated[bool, typer.Option("--bands", help="Split sunlight into ultraviolet, visible, infrared.")] = False,
    demands: Annotated[bool, typer.Option("--demands", help="Set lux beside what places of work demand.")] = False,
    units: Annotated[bool, typer.Option("--units", help="List all quantities and units.")] = False,
    json: Json = False,
) -> None:
    """Convert a quantity of light, and say what was assumed.

    JSON: `given`, `value`, `unit`, `steps` (`formula`, `assumption`, `value`, `unit`), `unused`; with `--km` or
    `--range` also `standard`, the same with Lesk's constants; with `--bands` also `bands`; with `--demands` also `demands`
    (`place`, `lux`, `share`, `met`); with `--units` only `quantities` and `units`.
    """
    if units:
        list_units(json)
        return
    if given is None:
        raise ParameterError('there is no quantity\nhint: lesk quantity "1100 lm" --to lx --at 1.5m')
    start = quantity(given)
    assumed: dict[str, Any] = {
        "distance": at,
        "cone": cone,
        "solid_angle": solid_angle,
        "area": area,
        "reflectance": reflectance,
        "incidence": incidence,
        "time": time,
        "width": width,
        "efficacy": efficacy,
        "spectrum": spectrum,
        "lambertian": lambertian,
        "dome": dome,
        "scotopic": scotopic,
    }
    wanted = to or _lesk_si(start)
    found = start.to(wanted, **assumed, range=range_, km=km)
    standard = start.to(wanted, **assumed) if km or range_ else None
    rows = split(found) if bands else None
    wants = compare(found) if demands else None
    if json:
        data: dict[str, Any] = {"given": given, **plain(found)}
        if standard is not None:
            data["standard"] = plain(standard)
        if rows is not None:
            data["bands"] = rows
        if wants is not None:
            data["demands"] = wants
        emit(data)
        return
    show(given, found)
    if standard is not None:
        print(f"\nwith Lesk's constants: {standard.value:.6g} {standard.unit}, a ratio of {_ratio(found, standard)}")
        show_steps(standard)
    if rows is not None:
        show_bands(rows, found.unit)
    if wants is not None:
        show_demands(wants)
    for name in found.unused:
        flag = "at" if name == "distance" else name.replace("_", "-")
        print(f"note: `--{flag}` was not needed", file=sys.stderr)


def _lesk_si(start: Quantity) -> str:
    return next(units[0] for name, _, _, units in _lesk.quantity_dimensions() if name == start.dimension)


def _ratio(found: Quantity, standard: Quantity) -> str:
    return f"{found.value / standard.value:.6g}" if standard.value else "0 to 0"


def plain(found: Quantity) -> dict[str, Any]:
    """What JSON says of a result."""
    return {
        "value": found.value,
        "unit": found.unit,
        "steps": [asdict(step) for step in found.steps],
        "unused": list(found.unused),
    }


def show(given: str, found: Quantity) -> None:
    """Print the result and its chain."""
    print(f"{found.value:.6g} {found.unit}")
    if found.steps:
        print(f"  {given.strip()}")
    show_steps(found)


def show_steps(found: Quantity) -> None:
    """Print the chain: value, formula, assumption."""
    values = [f"= {step.value:.6g} {step.unit}" for step in found.steps]
    for value, step in zip(values, found.steps, strict=True):
        print(f"  {value:{max(map(len, values))}}  {step.formula}  ({step.assumption})")


def split(found: Quantity) -> list[dict[str, Any]]:
    """Shares of sunlight in three bands: a black body's, and the lecture's."""
    if found.dimension not in ("irradiance", "radiant flux", "radiant energy", "radiant exposure", "radiance"):
        raise ParameterError(
            f"`--bands` splits watts, but the result is `{found.unit}` ({found.dimension})\nhint: ask for W, W/m2 or J"
        )
    ends = [0.0, *(_lesk.blackbody_share_below(nm, SUN_K) for nm in (380.0, 780.0)), 1.0]
    return [
        {
            "band": name,
            "share": ends[i + 1] - ends[i],
            "value": (ends[i + 1] - ends[i]) * found.value,
            "lecture_share": lecture,
            "lecture_value": lecture * found.value,
        }
        for i, (name, lecture) in enumerate(_LECTURE)
    ]


def show_bands(rows: list[dict[str, Any]], unit: str) -> None:
    """Print the table of bands."""
    places = ("below 380 nm", "380 to 780 nm", "above 780 nm")
    print(f"\n{'band':12} {'wavelengths':14} {f'black body {SUN_K:g} K':>24} {'the lecture':>22}")
    for row, place in zip(rows, places, strict=True):
        ours = f"{100 * row['share']:.1f} % {row['value']:10.5g} {unit}"
        theirs = f"{100 * row['lecture_share']:.0f} % {row['lecture_value']:8.4g} {unit}"
        print(f"{row['band']:12} {place:14} {ours:>24} {theirs:>22}")


def compare(found: Quantity) -> list[dict[str, Any]]:
    """Set an illuminance beside those that the lecture wants at places of work."""
    if found.dimension != "illuminance":
        raise ParameterError(
            f"`--demands` judges an illuminance, but the result is `{found.unit}` ({found.dimension})\nhint: ask for lx"
        )
    lux = found.to("lx").value
    return [
        {"place": place, "lux": wanted, "share": lux / wanted, "met": lux >= wanted} for place, wanted in ILLUMINANCES
    ]


def show_demands(rows: list[dict[str, Any]]) -> None:
    """Print the table of places."""
    print(f"\n{'place of work':16} {'demanded':>8} {'reached':>8}")
    for row in rows:
        print(
            f"{row['place']:16} {row['lux']:5.0f} lx {100 * row['share']:6.0f} %  {'met' if row['met'] else 'missed'}"
        )
    print("(the lecture's figures; `lesk lux --tasks` has those of EN 12464-1)")


def list_units(json: bool) -> None:
    """Print every quantity with its units, and every symbol."""
    quantities = [
        {"name": name, "czech": czech, "symbol": symbol, "units": units}
        for name, czech, symbol, units in _lesk.quantity_dimensions()
    ]
    symbols = [
        {"symbol": symbol, "name": name, "measures": dimension, "si": factor}
        for symbol, name, dimension, factor in _lesk.quantity_units()
    ]
    if json:
        emit({"quantities": quantities, "units": symbols})
        return
    print("Quantities and units people use for them; the first is the SI unit")
    for row in quantities:
        print(f"  {row['name']:22} {', '.join(row['units'])}")
    print(
        "\nSymbols; products like mW/cm2, W m-2 sr-1, umol/s/m2 are read, with prefixes f p n u m k M G T (c, d for m)"
    )
    for unit in symbols:
        print(f"  {unit['symbol']:8} {unit['name']:26} {unit['measures']}, {unit['si']:.9g} in SI")
