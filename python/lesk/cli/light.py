"""`lesk light`: luminaire files."""

from __future__ import annotations

import json as jsonlib
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk.cli._run import Json, emit
from lesk.errors import FileError, ParameterError
from lesk.light import REFLECTANCES, ROOMS, Luminaire, read

ENDINGS = (".png", ".svg", ".json", ".ies", ".ldt")
KINDS = ("polar", "web")


def main(
    files: Annotated[list[Path], typer.Argument(help="An IES or EULUMDAT file; a second one to compare with.")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="A file to write: .png, .svg, .json, .ies or .ldt.")
    ] = None,
    kind: Annotated[str, typer.Option(help="The picture: polar or web.")] = "polar",
    strict: Annotated[bool, typer.Option("--strict", help="Refuse what would be repaired with a warning.")] = False,
    lamp_set: Annotated[int, typer.Option(help="Lamp set of an EULUMDAT file, from 0.")] = 0,
    resample: Annotated[
        str | None, typer.Option(metavar="V[,H]", help="Steps of a new table in degrees, like `1,5`.")
    ] = None,
    edition: Annotated[int, typer.Option(help="Edition of LM-63 to write: 1986, 1991, 1995, 2002, 2019.")] = 2019,
    ugr: Annotated[bool, typer.Option("--ugr", help="Print the UGR table, too.")] = False,
    spacing: Annotated[float, typer.Option(help="UGR: spacing over height above the eye; 1 in CIE 190.")] = 0.25,
    json: Json = False,
) -> None:
    """Read a luminaire file: flux, angles, ratios, glare; draw it, convert it, compare it with another.

    JSON: `format`, `type`, `symmetry`, `flux_lm` (integrated; null with `flux_mw` instead where the file counts watts),
    `declared_flux_lm` with `declared_of`, `peak_cd`, `beam_angle_deg`, `field_angle_deg`, `efficacy_lm_per_w`,
    `light_output_ratio` (also `_up`, `_down`), `opening`, `lamp_sets`, `ugr`, `warnings` (`line`, `field`, `text`), ...;
    of two files a list `files`, and `difference`.
    """
    if len(files) > 2:
        raise ParameterError(f"{len(files)} files are given, but one or two are accepted")
    if output is not None and output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {', '.join(ENDINGS)} are accepted")
    if kind not in KINDS:
        raise ParameterError(f"`--kind` is `{kind}`, but {' and '.join(KINDS)} are accepted")
    lamps = [read(file, strict=strict, lamp_set=lamp_set) for file in files]
    if resample is not None:
        lamps = [lamp.resample(*_steps(resample)) for lamp in lamps]
    reports = [report(file, lamp, ugr=ugr or json, spacing=spacing) for file, lamp in zip(files, lamps, strict=True)]
    data: dict[str, Any] = reports[0] if len(files) == 1 else {"files": reports, "difference": difference(*lamps)}
    if output is not None:
        write(output, lamps, [file.name for file in files], kind, edition, data)
        print(f"{output} written", file=sys.stderr)
    for file, lamp in zip(files, lamps, strict=True):
        for warning in lamp.warnings:
            print(f"{file.name}, line {warning['line']}: {warning['field']} {warning['text']}", file=sys.stderr)
    if json:
        emit(data)
        return
    for i, item in enumerate(reports):
        if i:
            print()
        show(item)
    if len(files) == 2:
        show_difference(data["difference"])


def _steps(text: str) -> list[float]:
    from lesk.cli._run import numbers

    steps = numbers(text, "--resample")
    if len(steps) > 2:
        raise ParameterError(f"`--resample` is `{text}`, but one or two steps in degrees are accepted, like `1,5`")
    return steps


def report(file: Path, lamp: Luminaire, *, ugr: bool, spacing: float) -> dict[str, Any]:
    """Give what `--json` prints of one file."""
    facts = {"file": str(file), **lamp.facts}
    facts["beam_angle_deg"] = list(lamp.beam_angle_deg)
    facts["field_angle_deg"] = list(lamp.field_angle_deg)
    if ugr:
        table = lamp.ugr(spacing=spacing)
        uncorrected = lamp.ugr_uncorrected(spacing=spacing)
        facts["ugr"] = (
            None
            if table is None or uncorrected is None
            else {
                "spacing": spacing,
                "rooms_in_heights": ROOMS,
                "reflectances_percent": REFLECTANCES,
                "crosswise": table[:, :5].round(2),
                "endwise": table[:, 5:].round(2),
                "uncorrected_crosswise": uncorrected[:, :5].round(2),
                "uncorrected_endwise": uncorrected[:, 5:].round(2),
            }
        )
    return facts


def difference(first: Luminaire, second: Luminaire) -> dict[str, float | None]:
    """Compare two distributions: the flux, and the intensities direction by direction."""
    import numpy as np

    theta, phi = np.meshgrid(np.arange(0.5, 180), np.arange(0, 360, 5))
    a, b = (np.asarray(lamp.candela(theta, phi)) for lamp in (first, second))
    weight = np.sin(np.radians(theta))
    peak = max(a.max(), b.max()) or 1.0
    rms = float(np.sqrt(np.sum(weight * (a - b) ** 2) / np.sum(weight)))
    fluxes = [lamp.facts["flux_lm"] or lamp.facts["flux_mw"] for lamp in (first, second)]
    return {
        "flux_ratio": fluxes[1] / fluxes[0] if fluxes[0] else None,
        "rms_of_peak": rms / float(peak),
        "largest_of_peak": float(np.abs(a - b).max() / peak),
    }


def write(
    output: Path, lamps: list[Luminaire], names: list[str], kind: str, edition: int, data: dict[str, Any]
) -> None:
    """Write a picture, the data, or a converted file."""
    ending = output.suffix.lower()
    if ending in (".ies", ".ldt"):
        if len(lamps) > 1:
            raise ParameterError(f"two files are given, but `{output.name}` holds one luminaire")
        lamps[0].write(output, edition=edition)
        return
    try:
        if ending == ".json":
            from lesk.cli._run import _plain

            output.write_text(jsonlib.dumps({"version": 1, **data}, indent=2, default=_plain) + "\n", encoding="utf-8")
            return
        from lesk import plot

        if kind == "web" and len(lamps) > 1:
            raise ParameterError("two files are given, but a web shows one luminaire")
        fig = plot.web(lamps[0]) if kind == "web" else plot.intensity(lamps, names=names if len(lamps) > 1 else ())
        fig.savefig(output)
    except OSError as error:
        raise FileError(f"cannot write `{output}`: {(error.strerror or str(error)).lower()}") from None


def show(facts: dict[str, Any]) -> None:
    """Print the facts of one file."""
    rows = [
        ("file", facts["file"]),
        ("format", f"{facts['format']}, type {facts['type']}, symmetry {facts['symmetry']}"),
    ]
    counts_light = facts["flux_lm"] is not None
    unit, flux, declared = (
        ("lm", facts["flux_lm"], facts["declared_flux_lm"])
        if counts_light
        else ("mW", facts["flux_mw"], facts["declared_flux_mw"])
    )
    rows.append(("flux", f"{flux:.6g} {unit}"))
    if declared is not None:
        rows.append((f"declared ({facts['declared_of']})", f"{declared:.6g} {unit}"))
    peak = f"{facts['peak_cd']:.6g} cd" if counts_light else f"{facts['peak_mw_sr']:.6g} mW/sr"
    rows.append(
        ("largest intensity", f"{peak} at theta {facts['peak_theta_deg']:.4g}°, phi {facts['peak_phi_deg']:.4g}°")
    )
    for name, key in (("beam angle (50 %)", "beam_angle_deg"), ("field angle (10 %)", "field_angle_deg")):
        across, along = facts[key]
        rows.append((name, f"{across:.1f}° in C0-C180, {along:.1f}° in C90-C270"))
    if facts["efficacy_lm_per_w"] is not None:
        rows.append(("efficacy", f"{facts['efficacy_lm_per_w']:.4g} lm/W at {facts['watts']:g} W"))
    if facts["light_output_ratio"] is not None:
        ratios = [facts[f"light_output_ratio{part}"] for part in ("", "_down", "_up")]
        rows.append(("light output ratio", "{:.4g}, down {:.4g}, up {:.4g}".format(*ratios)))
    elif facts["downward_fraction"] is not None:
        rows.append(("downward share", f"{facts['downward_fraction']:.4g}"))
    opening = facts["opening"]
    size = " x ".join(f"{1000 * opening[key]:g}" for key in ("c0_m", "c90_m", "height_m"))
    rows.append(("luminous opening", opening["shape"] + ("" if opening["shape"] == "point" else f", {size} mm")))
    width = max(len(name) for name, _ in rows)
    for name, text in rows:
        print(f"{name:{width}}  {text}")
    if facts.get("ugr"):
        show_ugr(facts["ugr"])


def show_ugr(table: dict[str, Any]) -> None:
    """Print a UGR table."""
    heads = ["/".join(map(str, row)) for row in REFLECTANCES]
    print(f"\nUGR at a spacing of {table['spacing']:g} H, for this flux; ceiling/walls/floor")
    print(f"{'room':9}" + "".join(f"{head:>10}" for head in heads) + "  |" + "".join(f"{head:>10}" for head in heads))
    print(f"{'':9}{'crosswise':>50}  |{'endwise':>50}")
    for (across, along), left, right in zip(ROOMS, table["crosswise"], table["endwise"], strict=True):
        cells = ["".join(f"{value:10.1f}" for value in row) for row in (left, right)]
        print(f"{f'{across}H x {along}H':9}{cells[0]}  |{cells[1]}")


def show_difference(data: dict[str, Any]) -> None:
    """Print how two files differ."""
    if data["flux_ratio"] is not None:
        print(f"\nflux of the second over the first: {data['flux_ratio']:.5g}")
    print(
        f"intensities differ by {100 * data['rms_of_peak']:.3g} % of the peak (root mean square), "
        f"{100 * data['largest_of_peak']:.3g} % at most"
    )
