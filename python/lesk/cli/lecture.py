"""`lesk lecture`: the ideas of the lecture, and where its slides differ from their papers."""

from __future__ import annotations

import textwrap
from typing import Annotated

import typer

from lesk._errata import ERRATA, Erratum
from lesk._lecture import IDEAS
from lesk.cli._run import Json, emit
from lesk.errors import ParameterError, nearest


def main(
    part: Annotated[str, typer.Argument(help="`ideas` or `errata`.")] = "ideas",
    name: Annotated[str | None, typer.Argument(metavar="[ID]", help="One of the errata; without it, all.")] = None,
    json: Json = False,
) -> None:
    """List the ideas of a lecture on light and shading with their figures and commands, or its errata.

    JSON: `ideas`, a list with `slide`, `says`, `figures`, `commands`, `open`; or `errata`, a list with `id`, `slide`,
    `difference`, `case`, `unit`, `slide_value`, `paper_value`, `command`.
    """
    if part not in ("ideas", "errata"):
        raise ParameterError(
            f"`{part}` is given, but `ideas` and `errata` are accepted{nearest(part, ('ideas', 'errata'))}"
        )
    if part == "ideas":
        if name is not None:
            raise ParameterError(f"`{name}` is given, but `ideas` are listed as a whole")
        emit({"ideas": [idea._asdict() for idea in IDEAS]}) if json else _ideas()
        return
    known = {row.id: row for row in ERRATA}
    if name is not None and name not in known:
        raise ParameterError(
            f"there is no erratum `{name}`{nearest(name, known) or f'{chr(10)}hint: {chr(44).join(known)}'}"
        )
    rows = [known[name]] if name else list(ERRATA)
    if json:
        emit({"errata": [facts(row) for row in rows]})
        return
    for row in rows:
        _erratum(row)


def facts(row: Erratum) -> dict[str, object]:
    """Give what `--json` prints of an erratum."""
    return {
        "id": row.id,
        "slide": row.slide_title,
        "difference": row.difference,
        "case": row.case,
        "unit": row.unit,
        "slide_value": row.slide(),
        "paper_value": row.paper(),
        "command": row.command or f"lesk lecture errata {row.id}",
    }


def _ideas() -> None:
    for idea in IDEAS:
        print(f"{idea.slide}: {idea.says}")
        for figure in idea.figures:
            print(f"    lesk figure {figure} -o {figure}.png")
        for command in idea.commands:
            print(f"    {command}")
        if idea.open:
            print(f"    open: {idea.open}")


def _erratum(row: Erratum) -> None:
    unit = f" {row.unit}" if row.unit else ""
    print(f"{row.id}: {row.slide_title}")
    print(textwrap.indent(textwrap.fill(f"{row.difference}. {row.case}", 108), "    "))
    print(f"    slide {row.slide():.6g}{unit}, paper {row.paper():.6g}{unit}")
    if row.command:
        print(f"    {row.command}")
