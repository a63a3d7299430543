"""Running the claims of models."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from lesk import _lesk
from lesk._model import Model
from lesk._registry import MODELS, find


@dataclass(frozen=True)
class CheckReport:
    """What the checks of one or several models found."""

    models: list[dict[str, Any]]
    """One report per model, as `lesk check --json` prints them."""

    @property
    def passed(self) -> bool:
        """Whether every claim holds, and everything that is not claimed is refuted."""
        return all(model["passed"] for model in self.models)

    def html(self) -> str:
        """Write the reports as one page that needs no other file."""
        return str(_lesk.check_html(json.dumps(self.models)))

    def __str__(self) -> str:
        lines = []
        for model in self.models:
            lines.append(f"{model['id']}: {'ok' if model['passed'] else 'FAILED'}")
            lines += [f"  {row['property']:15} {row['verdict']:15} {row['note']}" for row in model["rows"]]
        return "\n".join(lines)


def check(model: str | Model | None = None, *, full: bool = False) -> CheckReport:
    """Run the claims of a model, or of all.

    Parameters
    ----------
    model : str or Model, optional
        The model; without it, all models. Claims hold over all legal parameters, so those of a `Model` do not matter.
    full : bool
        Take the time for tight bounds: minutes per model instead of seconds.

    Returns
    -------
    CheckReport
        `.passed`, and the rows of each model.

    Examples
    --------
    >>> import lesk
    >>> lesk.check("lambert").passed
    True
    """
    names = [info["id"] for info in MODELS] if model is None else [model.id if isinstance(model, Model) else model]
    reports: list[dict[str, Any]] = []
    for name in names:
        find(name)
        for report in json.loads(_lesk.check_json(name, full))["models"]:
            passed = all(row["verdict"] != "failed" for row in report["rows"])
            reports.append({"id": report["id"], "passed": passed, **report})
    return CheckReport(reports)
