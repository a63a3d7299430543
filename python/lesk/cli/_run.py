"""What all commands share: running, errors, JSON, and reading of options."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from lesk.errors import FileError, LeskError, ParameterError

Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
Settings = Annotated[
    list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A parameter; a colour is VALUE or R,G,B.")
]


def run(command: Callable[..., int | None], words: list[str]) -> int:
    """Run one command with its words; errors become text and a status."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.command(name=words[0])(command)
    try:
        status = app(words[1:], prog_name=f"lesk {words[0]}", standalone_mode=False)
        return int(status or 0)
    except LeskError as error:
        return fail(error)
    except typer.Exit as end:
        return end.exit_code
    except BrokenPipeError:
        # whoever read the output has seen enough; the interpreter must not try to flush it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        return fail(reason(error))
    except KeyboardInterrupt:
        return fail("interrupted", 130)
    except Exception as error:
        if hasattr(error, "format_message"):  # wrong use of an option
            return fail(f"{error.format_message()}\nhint: `lesk {words[0]} --help` lists the options")
        raise


def fail(what: object, status: int = 2) -> int:
    """Print an error in the style of the house."""
    text = str(what)
    # the faults of a scene come as a list that has the word already
    print(text if text.startswith("error: ") else f"error: {text}", file=sys.stderr)
    return status


def reason(error: OSError) -> str:
    """Say what the system refused, in the style of the house."""
    what = (error.strerror or str(error)).lower()
    return f"cannot use `{error.filename}`: {what}" if error.filename else what


def require_folder(file: Path) -> None:
    """Refuse a file whose folder does not exist, before work is done for it."""
    if not file.parent.is_dir():
        raise FileError(f"cannot write `{file}`: there is no folder `{file.parent}`\nhint: make the folder first")


def emit(data: dict[str, Any]) -> None:
    """Print JSON with its version."""
    print(json.dumps({"version": 1, **data}, indent=2, default=_plain))


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else str(value)


def parameters(settings: list[str] | None) -> dict[str, Any]:
    """Read `NAME=VALUE` words."""
    values: dict[str, Any] = {}
    for word in settings or []:
        name, equals, text = word.partition("=")
        if not equals:
            raise ParameterError(f"`--set {word}` has no value\nhint: write `--set {word}=0.2`")
        values[name] = numbers(text, f"--set {name}")
        if len(values[name]) == 1:
            values[name] = values[name][0]
    return values


def numbers(text: str, what: str) -> list[float]:
    """Read numbers with commas between them."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise ParameterError(f"`{what}` is `{text}`, but numbers like `0.2` or `0.1,0.2,0.3` are accepted") from None


def crease_angle_of(word: str | None) -> float | str | None:
    """Read degrees, or `stored`."""
    return word if word is None or word == "stored" else numbers(word, "--crease-angle")[0]


def direction(text: str, what: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Read `POLAR,AZIMUTH` in degrees as a unit vector."""
    angles = numbers(text, what)
    if len(angles) != 2:
        raise ParameterError(
            f"`{what}` is `{text}`, but a polar angle and an azimuth in degrees are accepted, like `30,0`"
        )
    if not np.isfinite(angles).all():
        raise ParameterError(f"`{what}` is `{text}`, but finite angles are accepted")
    theta, phi = np.radians(angles)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
