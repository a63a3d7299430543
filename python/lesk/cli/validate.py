"""`lesk validate`: readings against closed forms."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lesk import validate
from lesk.cli._run import Json, emit
from lesk.cli.lux import save
from lesk.errors import ParameterError


def main(
    what: Annotated[str, typer.Argument(help="`lights`.")],
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    markdown: Annotated[Path | None, typer.Option(help="Write the table as Markdown, too.")] = None,
    json: Json = False,
) -> int:
    """Compare illuminances and luminances with closed forms. Exit status 1 if one differs.

    JSON: `passed`, and `rows` with `group`, `what`, `expected`, `value`, `standard_error`, `unit`, `z` (of rows with
    noise), `deviation` (relative), `met`.
    """
    if what != "lights":
        raise ParameterError(f"there is nothing to validate called `{what}`, but `lights` is accepted")
    say = (lambda text: print(f"\r\033[K{text}", end="", file=sys.stderr)) if sys.stderr.isatty() else None
    rows = validate.lights(seed=seed, say=say)
    if say is not None:
        print("\r\033[K", end="", file=sys.stderr)
    passed = all(row.met for row in rows)
    if markdown is not None:
        save(markdown, validate.markdown(rows))
    if json:
        data = [{**vars(r), "z": r.z, "deviation": r.deviation, "met": r.met} for r in rows]
        emit({"passed": passed, "rows": data})
    else:
        show(rows)
    return 0 if passed else 1


def show(rows: list[validate.Compared]) -> None:
    """Print the table."""
    from rich.console import Console
    from rich.table import Table

    table = Table()
    for name in ("case", "", "closed form", "Lesk", "standard error", "z", ""):
        table.add_column(name, justify="left" if name in ("case", "") else "right")
    for r in rows:
        table.add_row(r.group, r.what, *validate.columns(r))
    Console(highlight=False).print(table)
    differ = [r for r in rows if not r.met]
    noisy = [r for r in rows if not r.deterministic]
    print(
        f"{len(rows)} rows, {len(differ)} differ: {len(rows) - len(noisy)} deterministic within "
        f"{validate.DETERMINISTIC:g}, {len(noisy)} with noise at |z| < {validate.Z:g}"
    )
