"""`lesk lux`: the surfaces of a scene against their requirements."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk import _lux
from lesk._lux import EDITION, LuxReport
from lesk._measure import MeasureProgress, scene_of
from lesk.cli._run import Json, emit
from lesk.errors import FileError, MeasureInterrupted, ParameterError


def main(
    scene: Annotated[Path | None, typer.Argument(help="The scene file.")] = None,
    error: Annotated[str | None, typer.Option(help="Relative standard error of every reading, like 1%.")] = None,
    sensor: Annotated[list[str] | None, typer.Option(help="Name of a sensor; may be repeated; else all.")] = None,
    time: Annotated[float | None, typer.Option(help="Seconds after which sampling stops.")] = None,
    threads: Annotated[int | None, typer.Option(help="Threads; else one per core.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the random numbers.")] = None,
    max_depth: Annotated[int | None, typer.Option(help="Reflections of a path at most; 0 is direct light.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write all readings as CSV.")] = None,
    html: Annotated[Path | None, typer.Option(help="Write a report with false-colour plans.")] = None,
    plan: Annotated[Path | None, typer.Option(help="Write the plan of the first grid: .png or .svg.")] = None,
    tasks: Annotated[bool, typer.Option("--tasks", help="List the rows of EN 12464-1 and end.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress.")] = False,
    json: Json = False,
) -> int:
    """Measure the sensors of a scene and check them. Exit status 1 if a requirement is not met. Ctrl-C keeps what is done.

    JSON: `passed`, `standard`, `maintenance_factor`, `surfaces` (maintained `mean`, `min`, `max`, `u0`, `ud`, `ugr`,
    `checks`), `readings` (initial `value`, `standard_error`, `half_interval`, `direct`, `indirect`, `samples`, `positions` in
    m, `glare`), `method`, `ended`, `seconds`.
    """
    if tasks:
        list_tasks(json)
        return 0
    if scene is None:
        raise ParameterError("`lesk lux` takes a scene file\nhint: `lesk lux --tasks` lists the rows of EN 12464-1")
    loaded = scene_of(scene)
    bar = None if quiet or not sys.stderr.isatty() else Bar()
    interrupted = False
    try:
        report = _lux.lux(
            loaded,
            sensors=sensor,
            error=None if error is None else share(error, "--error"),
            time=time,
            seed=seed,
            max_depth=max_depth,
            threads=threads,
            progress=bar,
        )
    except MeasureInterrupted as stopped:
        report, interrupted = LuxReport(loaded.title, stopped.measurement), True
    finally:
        if bar is not None:
            bar.close()
    if not report.measurement.sensors:
        raise ParameterError(f"`{scene}` has no sensor\nhint: add `[[sensors]]` with `type`, `name` and a place")
    write(report, loaded, csv, html, plan)
    if json:
        emit(report.data())
    else:
        show(report)
    if interrupted:
        print("interrupted: what was done until then is above, with its larger errors", file=sys.stderr)
        return 130
    return 0 if report.passed else 1


def share(text: str, what: str) -> float:
    """Read `1%` or `0.01`."""
    try:
        number = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except ValueError:
        number = float("nan")
    if not 0 < number <= 1:
        raise ParameterError(
            f"`{what}` is `{text}`, but a share above 0 and up to 100% is accepted, like `1%` or `0.01`"
        )
    return number


def write(report: LuxReport, scene: Any, csv: Path | None, html: Path | None, plan: Path | None) -> None:
    """Write the files that were asked for."""
    from lesk import _lux_page, plot

    if csv is not None:
        save(csv, report.csv())
    if html is not None:
        save(html, _lux_page.page(report, scene))
    if plan is not None:
        grids = [s for s in report.measurement.sensors if s.form in ("grid", "line")]
        if not grids:
            raise ParameterError("`--plan` is given, but no sensor is a grid or a line")
        figure = plot.plan(grids[0], factor=report.factor(grids[0]), scene=scene)
        try:
            figure.savefig(plan)
        except (OSError, ValueError) as error:
            raise FileError(f"cannot write `{plan}`: {str(error).lower()}") from None


def save(path: Path, text: str) -> None:
    """Write a text file."""
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(f"cannot write `{path}`: {(error.strerror or str(error)).lower()}") from None


def show(report: LuxReport) -> None:
    """Print the tables."""
    from rich.console import Console
    from rich.table import Table

    found = report.measurement
    # a file or pipe has no width of its own
    console = Console(highlight=False, width=None if sys.stdout.isatty() else 130)
    table = Table(title=report.title or None, title_justify="left")
    for name in ("surface", "points", "mean", "±", "min", "max", "U0", "Ud", "demanded", ""):
        table.add_column(name, justify="left" if name in ("surface", "demanded", "") else "right")
    for row in report.rows():
        table.add_row(*cells(row))
    console.print(table)
    for sensor in found.sensors:
        if sensor.glare is not None and sensor.glare.left_out:
            print(
                f"{sensor.name}: {sensor.glare.left_out} lights in sight have no luminous area and are left out of UGR"
            )
        if sensor.conversion:
            print(f"{sensor.name}: {sensor.conversion}")
    worst = max(s.relative_error for s in found.sensors)
    error = (
        "some readings have no samples" if worst != worst else f"greatest relative standard error {100 * worst:.2f} %"
    )
    print(f"maintained values: maintenance factor {report.maintenance_factor:g}; requirements: {EDITION}")
    print(f"{found.ended} after {found.seconds:.1f} s, {error}")


def cells(row: dict[str, Any]) -> list[str]:
    """Write one row of the table."""
    verdict = {None: "", True: "met", False: "NOT MET"}[row["met"]]
    if any(c["within_error"] for c in row["checks"]):
        verdict += " (within its error)"
    if row["form"] == "glare":
        value = "no glare" if row["ugr"] is None else f"UGR {row['ugr']:.1f}"
        wanted = ", ".join(f"UGR <= {c['limit']:g}" for c in row["checks"])
        error = "" if row["ugr"] is None else f"{row['ugr_standard_error']:.1g}"
        return [row["name"], "", value, error, "", "", "", "", wanted, verdict]
    ratios = ["" if row[k] is None or row["points"] == 1 else f"{row[k]:.2f}" for k in ("u0", "ud")]
    names = {"mean": "mean >=", "uniformity": "U0 >="}
    wanted = ", ".join(f"{names[c['what']]} {c['limit']:g}" for c in row["checks"])
    mean = f"{row['mean']:.4g} {row['unit']}"
    numbers = [f"{row['mean_standard_error']:.2g}", f"{row['min']:.4g}", f"{row['max']:.4g}"]
    return [row["name"], str(row["points"]), mean, *numbers, *ratios, wanted, verdict]


def list_tasks(json: bool) -> None:
    """Print the rows of EN 12464-1."""
    rows = _lux.tasks()
    if json:
        emit({"standard": EDITION, "tasks": [vars(task) for task in rows]})
        return
    print(f"{EDITION}\n{'task':20} {'Em lx':>6} {'UGR':>4} {'U0':>5} {'Ra':>4}  area")
    for t in rows:
        numbers = ["" if v is None else f"{v:g}" for v in (t.ugr, t.uniformity, t.color_rendering)]
        print(f"{t.id:20} {t.illuminance:6g} {numbers[0]:>4} {numbers[1]:>5} {numbers[2]:>4}  {t.name}")


class Bar:
    """A line with a bar, on a terminal."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

        columns = (TextColumn("measuring"), BarColumn(), TaskProgressColumn(), TextColumn("{task.fields[readings]}"))
        self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task("measure", total=1.0, readings="")
        self._progress.start()

    def __call__(self, now: MeasureProgress) -> None:
        """Show how far measuring is."""
        self._progress.update(self._task, completed=now.done, readings=f"{now.finished} of {now.total} readings")

    def close(self) -> None:
        """Remove the line."""
        self._progress.stop()
