"""`lesk render`: a scene becomes a picture."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lesk._render import Progress, Render, render
from lesk.cli._run import Json, emit
from lesk.errors import ParameterError, RenderInterrupted

ENDINGS = (".exr", ".png", ".hdr")


def main(
    scene: Annotated[Path, typer.Argument(help="The scene file.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture: .exr, .png or .hdr.")],
    spp: Annotated[int | None, typer.Option(help="Samples per pixel; else what the scene says.")] = None,
    time: Annotated[float | None, typer.Option(help="Seconds after which no pass begins.")] = None,
    threads: Annotated[int | None, typer.Option(help="Threads; else one per core.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the random numbers.")] = None,
    max_depth: Annotated[int | None, typer.Option(help="Scattering events of a path at most.")] = None,
    split: Annotated[str | None, typer.Option(help="Layers: direct,indirect,specular,caustic.")] = None,
    aovs: Annotated[bool, typer.Option("--aovs", help="Keep albedo, normal, depth and ids.")] = False,
    ev100: Annotated[float | None, typer.Option(help="Exposure of a PNG; else the scene's, else metered.")] = None,
    tonemap: Annotated[str, typer.Option(help="srgb, reinhard, hable, aces, agx or neutral.")] = "srgb",
    checkpoint: Annotated[Path | None, typer.Option(help="Where to keep the exact state.")] = None,
    checkpoint_every: Annotated[float, typer.Option(help="Seconds between checkpoints.")] = 60.0,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing but errors.")] = False,
    json: Json = False,
) -> int:
    """Render a scene. Ctrl-C keeps what is done.

    JSON: `output`, `ended`, `seconds`, `ev100`, `relative_error`, `rejected`, `resumed`.
    """
    if output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {', '.join(ENDINGS)} are accepted")
    if resume and checkpoint is None:
        checkpoint = output.with_suffix(".checkpoint")
    bar = None if quiet or not sys.stderr.isatty() else Bar()
    status = 0
    try:
        picture = render(
            scene,
            spp=spp,
            time=time,
            seed=seed,
            max_depth=max_depth,
            split=split.split(",") if split else None,
            aovs=aovs or None,
            threads=threads,
            checkpoint=checkpoint,
            checkpoint_every=checkpoint_every,
            resume=resume,
            progress=bar,
        )
    except RenderInterrupted as interrupted:
        picture, status = interrupted.render, 130
    finally:
        if bar is not None:
            bar.close()
    save(picture, output, ev100, tonemap)
    if json:
        emit(facts(picture, output, ev100))
    elif not quiet:
        report(picture, output, ev100, interrupted=status != 0)
    if status == 0 and checkpoint is not None and picture.ended == "done":
        checkpoint.unlink(missing_ok=True)
    return status


def save(picture: Render, output: Path, ev100: float | None, mapper: str) -> None:
    """Write the picture."""
    picture.save(output, ev100=ev100, mapper=mapper)


def facts(picture: Render, output: Path, ev100: float | None) -> dict[str, object]:
    """Give what `--json` prints."""
    return {
        "output": str(output),
        "ended": picture.ended,
        "seconds": picture.seconds,
        "ev100": picture.ev100 if ev100 is None else ev100,
        "relative_error": picture.relative_error,
        "rejected": picture.rejected,
        "resumed": picture.resumed,
    }


def report(picture: Render, output: Path, ev100: float | None, *, interrupted: bool) -> None:
    """Say what was done, on standard error."""
    how = "interrupted" if interrupted else picture.ended
    shown = picture.ev100 if ev100 is None else ev100
    exposure = "" if shown is None else f", EV100 {shown:.2f}"
    error = "" if picture.relative_error is None else f", relative error {100 * picture.relative_error:.2f} %"
    print(f"{output}: {how} after {picture.seconds:.1f} s{exposure}{error}", file=sys.stderr)
    if interrupted:
        print("what was done until then is in the picture", file=sys.stderr)
    if picture.rejected:
        print(f"{picture.rejected} samples were not finite and count as black", file=sys.stderr)


class Bar:
    """A line with a bar and the time left, on a terminal."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

        columns = (TextColumn("rendering"), BarColumn(), TaskProgressColumn(), TextColumn("{task.fields[left]}"))
        self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task("render", left="")
        self._progress.start()

    def __call__(self, now: Progress) -> None:
        """Show how far the render is."""
        left = "" if now.left is None else f"{now.left:.0f} s left"
        self._progress.update(self._task, completed=now.done, total=now.total, left=left)

    def close(self) -> None:
        """Remove the line."""
        self._progress.stop()
