"""`lesk shader`: source in shading languages."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lesk._registry import find
from lesk._shader import export
from lesk.cli._run import Json, emit, require_folder


def main(
    name: Annotated[str, typer.Argument(help="The model.")],
    to: Annotated[str, typer.Option("--to", help="glsl, glsl-es, wgsl, hlsl, msl or spirv.")] = "glsl",
    part: Annotated[list[str] | None, typer.Option(help="eval, pdf, sample or draw; may be repeated.")] = None,
    math: Annotated[str, typer.Option(help="`builtin`: the target's functions; `exact`: own polynomials.")] = "builtin",
    complete: Annotated[bool, typer.Option("--complete", help="A complete shader, not functions to paste.")] = False,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="The file; without it, standard output.")
    ] = None,
    json: Json = False,
) -> None:
    """Write a model as shader source.

    JSON: `model`, `language`, `source` (text; SPIR-V as hexadecimal digits).
    """
    if output is not None:
        require_folder(output)
    source = export(find(name)["id"], to, parts=part or ["eval", "pdf", "sample"], math=math, complete=complete)
    if json:
        emit({"model": name, "language": to, "source": source if isinstance(source, str) else source.hex()})
    elif output is not None:
        output.write_bytes(source.encode() if isinstance(source, str) else source)
    elif isinstance(source, str):
        print(source)
    else:
        sys.stdout.buffer.write(source)
