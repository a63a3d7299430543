"""The examples of the docstrings, the page of the demo, and how fast the package is there."""

from __future__ import annotations

import doctest
import pkgutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import lesk

MODULES = [m.name for m in pkgutil.walk_packages(lesk.__path__, "lesk.") if not m.name.endswith("._lesk")]
ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", ["lesk", *MODULES])
def test_examples_of_docstrings_print_what_they_say(name):
    assert doctest.testmod(import_module(name)).failed == 0


def test_importing_loads_neither_numpy_nor_matplotlib():
    # what makes `import lesk` and `lesk --help` fast on every machine, however busy
    code = (
        "import sys, lesk, lesk.cli; print([m for m in ('numpy', 'matplotlib', 'typer', 'rich') if m in sys.modules])"
    )
    answer = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


@pytest.mark.parametrize("name", ["demo.toml", "light_paths.toml"])
def test_scenes_of_the_package_are_those_of_the_examples(name):
    example = ROOT / "examples" / "scenes" / name
    if not example.is_file():
        pytest.skip("the examples are not here")
    packaged = Path(lesk.__file__).parent / "data" / name
    assert packaged.read_bytes() == example.read_bytes()
