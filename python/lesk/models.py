"""Every model of the registry as a class: `lesk.models.ggx(alpha_x=0.2)`.

`lesk.models.ALL` holds the classes by name, in reading order, and `lesk.models.create` makes a model by its name.
"""

from __future__ import annotations

from lesk._docstring import model_docstring
from lesk._model import Model
from lesk._registry import MODELS, find

ALL: dict[str, type[Model]] = {}
"""The classes by name, in reading order."""


def create(name: str, **parameters: object) -> Model:
    """Make a model by its name.

    Parameters
    ----------
    name : str
        The id, as in `lesk models`.
    **parameters : array_like
        Values by name; the others have their defaults.

    Returns
    -------
    Model

    Raises
    ------
    ParameterError
        If there is no such model or parameter, or a value is outside its range.
    """
    find(name)
    return ALL[name](**parameters)  # type: ignore[arg-type]


for _info in MODELS:
    _members = {
        "id": _info["id"],
        "info": _info,
        "__doc__": model_docstring(_info),
        "__module__": __name__,
    }
    ALL[_info["id"]] = type(_info["id"], (Model,), _members)
globals().update(ALL)
__all__ = list(ALL)
