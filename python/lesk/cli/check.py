"""`lesk check`: the claims of models."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk._check import CheckReport, check
from lesk._registry import MODELS, find
from lesk.cli._run import Json, emit, require_folder


def main(
    name: Annotated[str | None, typer.Argument(help="A model; without it, all.")] = None,
    full: Annotated[bool, typer.Option("--full", help="Minutes per model, for tight bounds.")] = False,
    html: Annotated[Path | None, typer.Option(help="Write the report as a page, too.")] = None,
    json: Json = False,
) -> int:
    """Run the claims of a model, or of all. Exit status 1 if one does not hold.

    JSON: `passed`, and `models`, a list with `id`, `passed`, `rows` (`property`, `condition`, `verdict`, `value`,
    `allowed`, `place`, `note`, `seconds`), `albedo`, `seconds`.
    """
    if html is not None:
        require_folder(html)
    names = [info["id"] for info in MODELS] if name is None else [find(name)["id"]]
    reports: list[dict[str, Any]] = []
    for i, model in enumerate(names):
        if len(names) > 1:
            print(f"{i + 1}/{len(names)} {model}", file=sys.stderr)
        reports += check(model, full=full).models
        if not json:
            show(reports[-1])
    report = CheckReport(reports)
    if html is not None:
        html.write_text(report.html(), encoding="utf-8")
        print(f"report in {html}", file=sys.stderr)
    if json:
        emit({"passed": report.passed, "models": reports})
    return 0 if report.passed else 1


def show(model: dict[str, Any]) -> None:
    """Print the table of a model."""
    from rich.console import Console
    from rich.table import Table

    class Output(Console):
        def on_broken_pipe(self) -> None:
            # rich would end with status 1, which says that a check came out false
            raise BrokenPipeError

    table = Table(title=f"{model['id']}: {'ok' if model['passed'] else 'FAILED'}", title_justify="left")
    for column in ("property", "condition", "verdict", "worst", "allowed", "s"):
        table.add_column(column, justify="right" if column in ("worst", "allowed", "s") else "left")
    for row in model["rows"]:
        shown = ["" if row[key] is None else f"{row[key]:.4g}" for key in ("value", "allowed")]
        table.add_row(row["property"], row["condition"] or "always", row["verdict"], *shown, f"{row['seconds']:.2f}")
    Output(highlight=False).print(table)
