"""`lesk eval`: one pair of directions."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import typer

from lesk.cli._run import Json, Settings, direction, emit, parameters
from lesk.models import create


def main(
    name: Annotated[str, typer.Argument(help="The model.")],
    wi: Annotated[str, typer.Option(help="Direction to the light: polar angle and azimuth in degrees.")] = "30,0",
    wo: Annotated[str, typer.Option(help="Direction to the viewer, likewise.")] = "30,180",
    set_: Settings = None,
    json: Json = False,
) -> None:
    """Evaluate a model for one pair of directions.

    JSON: `model`, `params`, `wi_deg`, `wo_deg`, `f` (1/sr per channel), `pdf` (1/sr), `albedo` (per channel), `delta`
    (a list of `wi`, `weight`, `probability`).
    """
    model = create(name, **parameters(set_))
    light, viewer = direction(wi, "--wi"), direction(wo, "--wo")
    f, pdf, albedo = model.eval(light, viewer), float(model.pdf(light, viewer)), model.albedo(viewer)
    lobes = model.delta(viewer)
    delta = [
        {"wi": lobes.wi[i], "weight": lobes.weight[i], "probability": float(lobes.probability[i])}
        for i in range(len(lobes.probability))
        if lobes.probability[i] > 0
    ]
    if json:
        angles = {"wi_deg": [float(a) for a in wi.split(",")], "wo_deg": [float(a) for a in wo.split(",")]}
        emit(
            {
                "model": name,
                "params": dict(model.params),
                **angles,
                "f": f,
                "pdf": pdf,
                "albedo": albedo,
                "delta": delta,
            }
        )
        return
    print(f"f       {_text(f)} 1/sr\npdf     {pdf:.8g} 1/sr\nalbedo  {_text(albedo, 4)}")
    for lobe in delta:
        print(f"delta   weight {_text(lobe['weight'])}, probability {lobe['probability']:.6g}, wi {_text(lobe['wi'])}")


def _text(values: np.ndarray, digits: int = 8) -> str:
    return " ".join(f"{value:.{digits}g}" for value in np.atleast_1d(values))
