"""Prints `lesk/models.pyi`, the typed stub of the models' classes, from the registry; see `cargo xtask codegen`."""

from lesk import models
from lesk._model import REGISTRY

HEAD = '''"""Written by `cargo xtask codegen` from the registry."""

import numpy.typing as npt

from lesk._model import Model as Model
from lesk._model import Sample as Sample
'''


def stub(info):
    """Write the stub of one class: its documentation, and its parameters with their defaults."""
    name = info["id"]
    parameters = "".join(f", {p['name']}: npt.ArrayLike = {p['default']!r}" for p in info["parameters"])
    text = getattr(models, name).__doc__.strip()
    documentation = "\n".join(f"    {line}".rstrip() for line in text.splitlines()).lstrip()
    return f'''

class {name}(Model):
    r"""{documentation}
    """

    def __init__(self, *{parameters}) -> None: ...
'''


print(HEAD, *map(stub, REGISTRY), sep="", end="")
