"""The command `lesk`; one file per command."""

from __future__ import annotations

import sys
from importlib import import_module

COMMANDS = {
    "models": "List the models, or describe one.",
    "eval": "Evaluate a model for one pair of directions.",
    "plot": "Draw a model: polar cut, lobe, slice, albedo, sphere, term.",
    "check": "Run the claims of a model, or of all.",
    "shader": "Write a model as shader source.",
    "light": "Read a luminaire file: flux, angles, glare, pictures, conversion.",
    "sky": "Say what a cloudless sky and its sun give, or draw it.",
    "quantity": "Convert a quantity of light; every assumption is named.",
    "spectrum": "Say what a light is: colour, temperature, rendering, efficacy.",
    "render": "Render a scene.",
    "lux": "Measure the sensors of a scene and check them.",
    "falsecolor": "Show luminance or illuminance in false colours.",
    "validate": "Compare with closed forms.",
    "compare-shading": "Flat, Gouraud and Phong shading beside what they approximate.",
    "mesh": "Say what a mesh file holds: faces, edges by kind, normals.",
    "scene": "Check a scene file, or print the schema.",
    "figure": "Make a figure of the lecture, or list them.",
    "lecture": "List the ideas of a lecture on light and shading, or its errata.",
    "demo": "Render the demo scene and write a page about it.",
}
"""The commands with their first lines, in the order of `lesk --help`. Each is a module of this package with a `main`."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit status: 0 fine, 1 a check came out false, 2 bad input."""
    words = sys.argv[1:] if arguments is None else arguments
    if not words:
        print(overview(), file=sys.stderr)
        return 2
    if words[0] in ("-h", "--help"):
        print(overview())
        return 0
    if words[0] == "--version":
        from lesk import _lesk

        print(f"lesk {_lesk.__version__} ({_lesk.isa})")
        return 0
    if words[0] not in COMMANDS:
        from lesk.errors import nearest

        hint = nearest(words[0], COMMANDS) or "\nhint: `lesk --help` lists the commands"
        print(f"error: there is no command `{words[0]}`{hint}", file=sys.stderr)
        return 2
    from lesk.cli._run import run

    return run(import_module(f"lesk.cli.{words[0].replace('-', '_')}").main, words)


def overview() -> str:
    """Say what `lesk --help` prints."""
    width = max(map(len, COMMANDS))
    rows = "\n".join(f"  {name:{width}}  {line}" for name, line in COMMANDS.items())
    return (
        "Usage: lesk COMMAND [OPTIONS]\n\nA light-and-shading workbench: every reflectance model written once.\n\n"
        f"Commands:\n{rows}\n\nOptions:\n  --version  Version and instruction set.\n  --help     This text; "
        "`lesk COMMAND --help` tells more.\n"
    )


if __name__ == "__main__":
    sys.exit(main())
