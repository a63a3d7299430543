"""Rendering scenes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import CheckpointError, ParameterError, RenderInterrupted
from lesk.scene import Scene, load, parse


class Progress(NamedTuple):
    """How far a render is."""

    done: int
    """Samples done, of all pixels together."""
    total: int
    """Samples in all."""
    elapsed: float
    """Seconds so far."""
    left: float | None
    """Seconds to the end, estimated; None before anything is done."""


class Render:
    """A rendered picture with all its layers."""

    def __init__(self, picture: _lesk.Picture) -> None:
        self._picture = picture

    @property
    def rgb(self) -> npt.NDArray[np.float32]:
        """Linear Rec.709 whose luminance Y is cd/m², shape (height, width, 3)."""
        return self._picture.rgb()

    @property
    def layers(self) -> Mapping[str, npt.NDArray[Any]]:
        """All channels by their names in an EXR file (`variance.R`, `albedo.G`, ...), shape (height, width)."""
        return dict(self._picture.channels())

    @property
    def variance(self) -> npt.NDArray[np.float32]:
        """Variance of the mean, (cd/m²)², shape (height, width, 3)."""
        layers = self.layers
        return np.stack([layers[f"variance.{c}"] for c in "RGB"], axis=-1)

    @property
    def ev100(self) -> float | None:
        """The exposure that the scene states, or what a meter reads; None for a black picture."""
        return self._picture.ev100()

    @property
    def relative_error(self) -> float | None:
        """Root of the mean variance over the mean luminance; None for a black picture."""
        return self._picture.relative_error

    @property
    def ended(self) -> str:
        """How it ended: `done`, `out of time` or `stopped`."""
        return self._picture.ended

    @property
    def seconds(self) -> float:
        """How long it took, s."""
        return self._picture.seconds

    @property
    def rejected(self) -> int:
        """Samples whose light was not finite; they count as black."""
        return self._picture.rejected

    @property
    def resumed(self) -> int:
        """Samples that came from the checkpoint."""
        return self._picture.resumed

    def save(self, path: str | Path, *, ev100: float | None = None, mapper: str = "srgb") -> None:
        """Write the picture; the ending of the name decides on the format.

        Parameters
        ----------
        path : path-like
            `.exr` holds all layers, linear; `.png` is exposed and tone mapped; `.hdr` is linear RGB.
        ev100 : float, optional
            Exposure of a PNG; without it, `Render.ev100`.
        mapper : str
            Tone mapper of a PNG, one of `lesk.image.TONE_MAPPERS`.
        """
        self._picture.save(Path(path), self.ev100 if ev100 is None else ev100, mapper)

    def __repr__(self) -> str:
        width, height = self._picture.size
        return f"<lesk.Render of {width} x {height} pixels, {self.ended} after {self.seconds:.1f} s>"


def render(
    scene: str | Path | Scene,
    *,
    spp: int | None = None,
    time: float | None = None,
    seed: int | None = None,
    max_depth: int | None = None,
    shadow_terminator: str | None = None,
    split: Sequence[str] | None = None,
    aovs: bool | None = None,
    threads: int | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float = 60.0,
    resume: bool = False,
    progress: Callable[[Progress], object] | None = None,
) -> Render:
    """Render a scene.

    Parameters
    ----------
    scene : path-like, str or Scene
        A scene file; text of one, if it has line breaks; or a scene that was read before.
    spp : int, optional
        Samples per pixel. What is not given here is taken from the scene.
    time : float, optional
        Seconds after which no further pass begins.
    seed : int, optional
        Seed; the same seed, samples, build and instruction set give the same bits for any number of threads.
    max_depth : int, optional
        Scattering events of a path at most.
    shadow_terminator : str, optional
        Where rays start on opaque faces with interpolated normals: `hanika`, from points raised to the surface that
        the faces stand for; `none`, from the face, whose own shadow then has a border of blocks.
    split : sequence of str, optional
        Light-path layers: `direct`, `indirect`, `specular`, `caustic`.
    aovs : bool, optional
        Whether to keep albedo, normal, depth and ids.
    threads : int, optional
        Threads; without it, one per core.
    checkpoint : path-like, optional
        Where to keep the exact state, every `checkpoint_every` seconds and when the render is stopped.
    checkpoint_every : float
        Seconds between checkpoints.
    resume : bool
        Go on from the checkpoint.
    progress : callable, optional
        Called with a `Progress` about twenty times per second.

    Returns
    -------
    Render

    Raises
    ------
    SceneError, ParameterError, CheckpointError
        What was given and what is accepted.
    RenderInterrupted
        On Ctrl-C; its `.render` holds what was done.
    """
    if spp is not None and spp < 1:
        raise ParameterError(f"`spp` is {spp}, but 1 or more is accepted")
    if time is not None and not 0 <= time < 1e9:
        raise ParameterError(f"`time` is {time:g}, but 0 to below 1e9 seconds are accepted")
    if threads is not None and threads < 1:
        raise ParameterError(f"`threads` is {threads}, but 1 or more is accepted")
    if resume and checkpoint is None:
        raise ParameterError("`resume` needs a checkpoint\nhint: give `checkpoint`, the file to go on from")
    if resume and not Path(str(checkpoint)).is_file():
        raise CheckpointError(
            f"there is no checkpoint `{checkpoint}` to go on from\nhint: a render with `checkpoint` writes one"
        )
    if not isinstance(scene, Scene):
        scene = parse(scene) if isinstance(scene, str) and "\n" in scene else load(scene)
    wishes = {
        "spp": spp,
        "time": time,
        "seed": seed,
        "max_depth": max_depth,
        "shadow_terminator": shadow_terminator,
        "split": None if split is None else list(split),
        "aovs": aovs,
        "threads": threads,
        "checkpoint": None if checkpoint is None else (Path(checkpoint), checkpoint_every),
        "resume": resume,
    }
    observe = None if progress is None else (lambda *now: progress(Progress(*now)))
    picture = _lesk.render(scene, wishes, observe)
    if isinstance(picture.raised, KeyboardInterrupt):
        raise RenderInterrupted(Render(picture)) from None
    if picture.raised is not None:
        raise picture.raised
    return Render(picture)
