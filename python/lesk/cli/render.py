"""`lesk render`: a scene becomes a picture."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from lesk._raster import Shading, shade
from lesk._render import Progress, Render, render
from lesk.cli._run import Json, crease_angle_of, emit, numbers, require_folder
from lesk.errors import ParameterError, RenderInterrupted, nearest, quoted
from lesk.image import TONE_MAPPERS

ENDINGS = (".exr", ".png", ".hdr")


def main(
    scene: Annotated[Path, typer.Argument(help="The scene file.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture: .exr, .png or .hdr.")],
    spp: Annotated[int | None, typer.Option(help="Samples per pixel; else what the scene says.")] = None,
    time: Annotated[float | None, typer.Option(help="Seconds after which no pass begins.")] = None,
    threads: Annotated[int | None, typer.Option(help="Threads; else one per core.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the random numbers.")] = None,
    max_depth: Annotated[int | None, typer.Option(help="Scattering events of a path at most.")] = None,
    shadow_terminator: Annotated[str | None, typer.Option(help="hanika or none; else what the scene says.")] = None,
    split: Annotated[str | None, typer.Option(help="Layers: direct,indirect,specular,caustic.")] = None,
    aovs: Annotated[bool, typer.Option("--aovs", help="Keep albedo, normal, depth and ids.")] = False,
    engine: Annotated[str, typer.Option(help="path or raster.")] = "path",
    shading: Annotated[str | None, typer.Option(help="Raster: flat, gouraud or phong.")] = None,
    interpolation: Annotated[str | None, typer.Option(help="Raster: bilinear or barycentric.")] = None,
    correction: Annotated[str | None, typer.Option(help="Raster: perspective or screen.")] = None,
    normals: Annotated[str | None, typer.Option(help="Raster: given, analytic, mean, area, angle or max1999.")] = None,
    crease_angle: Annotated[str | None, typer.Option(help="Raster: edges above are real, degrees; or stored.")] = None,
    tessellation: Annotated[int | None, typer.Option(help="Raster: faces around a curved shape.")] = None,
    subdivide: Annotated[int | None, typer.Option(help="Raster: how often faces of meshes are cut into four.")] = None,
    supersampling: Annotated[int | None, typer.Option(help="Raster: samples along each side of a pixel.")] = None,
    quadrature: Annotated[int | None, typer.Option(help="Raster: points per light with an area.")] = None,
    shadows: Annotated[
        bool | None, typer.Option("--shadows/--no-shadows", help="Raster: hard shadows by rays.")
    ] = None,
    renormalize: Annotated[
        bool | None,
        typer.Option("--renormalize/--no-renormalize", help="Raster: unit lengths of interpolated normals."),
    ] = None,
    cull: Annotated[
        bool | None, typer.Option("--cull/--no-cull", help="Raster: leave out faces seen from behind.")
    ] = None,
    flat_point: Annotated[str | None, typer.Option(help="Raster: of a flat face, centroid or first.")] = None,
    space: Annotated[str | None, typer.Option(help="Raster: linear or gamma.")] = None,
    classic: Annotated[
        str | None, typer.Option(help="Raster: classic model, as ka=0.1,kd=0.5,ks=0.4,h=50; or none.")
    ] = None,
    ev100: Annotated[float | None, typer.Option(help="Exposure of a PNG; else the scene's, else metered.")] = None,
    tonemap: Annotated[str, typer.Option(help="srgb, reinhard, hable, aces, agx or neutral.")] = "srgb",
    checkpoint: Annotated[Path | None, typer.Option(help="Where to keep the exact state.")] = None,
    checkpoint_every: Annotated[float, typer.Option(help="Seconds between checkpoints.")] = 60.0,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing but errors.")] = False,
    json: Json = False,
) -> int:
    """Render a scene. Ctrl-C keeps what is done.

    JSON: `output`, `ended`, `seconds`, `ev100`, `relative_error`, `rejected`, `resumed`; with the raster engine also
    `counts` of faces, vertices, samples and evaluations of models, and `warnings`.
    """
    # before the work, not after it
    if output.suffix.lower() not in ENDINGS:
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but {', '.join(ENDINGS)} are accepted")
    if tonemap not in TONE_MAPPERS:
        hint = nearest(tonemap, TONE_MAPPERS)
        raise ParameterError(f"`--tonemap` is `{tonemap}`, but {quoted(TONE_MAPPERS)} are accepted{hint}")
    if ev100 is not None and not -50 <= ev100 <= 50:
        raise ParameterError(f"`--ev100` is {ev100:g}, but -50 to 50 is accepted")
    require_folder(output)
    if engine not in ("path", "raster"):
        raise ParameterError(f"there is no engine `{engine}`, but path, raster are accepted")
    raster: dict[str, Any] = {
        "shading": shading,
        "interpolation": interpolation,
        "correction": correction,
        "normals": normals,
        "crease_angle": crease_angle,
        "tessellation": tessellation,
        "subdivide": subdivide,
        "supersampling": supersampling,
        "quadrature": quadrature,
        "shadows": shadows,
        "renormalize": renormalize,
        "cull": cull,
        "flat_point": flat_point,
        "space": space,
        "classic": classic,
    }
    if engine == "raster":
        raster["crease_angle_deg"] = crease_angle_of(raster.pop("crease_angle"))
        raster["classic"] = classic_of(classic)
        shaded = shade(scene, **raster, shadow_terminator=shadow_terminator, aovs=aovs or None, threads=threads)
        return finish_shading(shaded, output, ev100, tonemap, json=json, quiet=quiet)
    if meant := [name for name, value in raster.items() if value is not None]:
        option = "--" + meant[0].replace("_", "-")
        raise ParameterError(f"`{option}` is for the rasteriser\nhint: add `--engine raster`")
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
            shadow_terminator=shadow_terminator,
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


def classic_of(words: str | None) -> dict[str, object] | bool | None:
    """Read `ka=0.1,kd=0.5,ks=0.4,h=50,highlight=blinn`, or `none` for the materials; no words give None."""
    if words is None:
        return None
    if words == "none":
        return False
    out: dict[str, object] = {}
    for word in filter(None, words.split(",")):
        name, _, value = word.partition("=")
        name = "shininess" if name == "h" else name
        if name not in ("ka", "kd", "ks", "shininess", "highlight") or not value:
            raise ParameterError(
                f"`--classic` has `{word}`, but ka=, kd=, ks=, h= with a number and highlight=phong or blinn are accepted"
            )
        out[name] = value if name == "highlight" else numbers(value, f"--classic {name}")[0]
    return out


def finish_shading(shaded: Shading, output: Path, ev100: float | None, mapper: str, *, json: bool, quiet: bool) -> int:
    """Write a rasterised picture and say what it took."""
    save(shaded, output, ev100, mapper)
    if json:
        emit({**facts(shaded, output, ev100), "counts": shaded.counts, "warnings": shaded.warnings})
        return 0
    if not quiet:
        for warning in shaded.warnings:
            print(f"warning: {warning}", file=sys.stderr)
        exposure = shaded.ev100 if ev100 is None else ev100
        shown = "" if exposure is None else f", EV100 {exposure:.2f}"
        counts = shaded.counts
        print(
            f"{output}: {shaded.milliseconds[-1]:.1f} ms, {counts['faces']} faces, {counts['vertices']} vertices, "
            f"{counts['samples']} samples, models evaluated at {counts['evaluations']} points{shown}",
            file=sys.stderr,
        )
    return 0


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


def duration(seconds: float) -> str:
    """Tell a time as people do: `42 s`, `7 min`, `3 h 20 min`."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"


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
        left = "" if now.left is None else f"{duration(now.left)} left"
        self._progress.update(self._task, completed=now.done, total=now.total, left=left)

    def close(self) -> None:
        """Remove the line."""
        self._progress.stop()
