"""Models over arrays."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import ParameterError

Array = npt.NDArray[np.floating[Any]]

REGISTRY: list[dict[str, Any]] = json.loads(_lesk.registry_json())["models"]
"""The models with their parameters and claims, as `lesk models --json` prints them."""


class Sample(NamedTuple):
    """Directions drawn by `Model.sample`, with arrays of the broadcast leading shape."""

    wi: Array
    """Unit vectors to the light, shape (..., 3)."""
    weight: Array
    """f |cos wi| / pdf per channel, shape (..., 3); 0 for a failed draw."""
    pdf: Array
    """Density in 1/sr, or the probability of a delta lobe, shape (...); 0 for a failed draw."""
    delta: npt.NDArray[np.bool_]
    """Whether a delta lobe was taken, shape (...)."""


class Model:
    """A scattering model with its parameters.

    Directions are unit vectors of shape (..., 3) in the local frame (normal +z, tangent +x) and leave the surface:
    `wi` to the light, `wo` to the viewer. Leading shapes of directions and parameters broadcast. float32 directions
    give float32 results; anything else is computed and returned in float64.
    """

    id: ClassVar[str] = ""
    info: ClassVar[dict[str, Any]] = {}

    def __init__(self, **parameters: npt.ArrayLike) -> None:
        specs = {spec["name"]: spec for spec in self.info["parameters"]}
        for name in parameters:
            if name not in specs:
                raise ParameterError(_unknown(name, self.id, list(specs)))
        self._values = {
            name: _checked(parameters.get(name, spec["default"]), spec, self.id) for name, spec in specs.items()
        }

    @property
    def params(self) -> Mapping[str, Array]:
        """The parameters by name: shape (...) for numbers, (..., 3) for colours."""
        return dict(self._values)

    @property
    def entries(self) -> list[str]:
        """Names of the entries of the flat parameter table: the last axis of `gradient`."""
        channels = {1: [""], 3: [".r", ".g", ".b"]}
        return [
            spec["name"] + suffix
            for spec in self.info["parameters"]
            for suffix in (channels[spec["length"]] if spec["kind"] == "color" else [""])
        ]

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """The BSDF f(wi, wo) without the cosine.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.

        Returns
        -------
        ndarray of shape (..., 3)
            f in 1/sr per channel; 0 outside the model's domain and for directions that are not finite.

        Raises
        ------
        ParameterError
            If a direction is not of unit length, or shapes do not broadcast.
        """
        return self._batch("eval", 3, "wi", wi, wo)

    def pdf(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """The density with which `sample` draws `wi` given `wo`, continuous part.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.

        Returns
        -------
        ndarray of shape (...)
            Density in 1/sr over `wi`.
        """
        return cast(Array, self._batch("pdf", 1, "wi", wi, wo)[..., 0])

    def sample(self, wo: npt.ArrayLike, u: npt.ArrayLike | None = None, *, seed: int = 0) -> Sample:
        """Draws directions to the light.

        Parameters
        ----------
        wo : array_like of shape (..., 3)
            Unit vectors to the viewer, local frame.
        u : array_like of shape (..., 3), optional
            Numbers in [0, 1); the third chooses a lobe. Without it, one direction is drawn per `wo`.
        seed : int
            Seed of the random numbers used when `u` is not given.

        Returns
        -------
        Sample
            wi, weight, pdf, delta.
        """
        wo = _vectors("wo", wo)
        if u is None:
            shape = np.broadcast_shapes(wo.shape[:-1], *(self._leading(v, s) for v, s in self._pairs()))
            dtype = np.float32 if wo.dtype == np.float32 else np.float64
            u = np.random.Generator(np.random.Philox(seed)).random((*shape, 3), dtype=dtype)
        out = self._batch("draw", 8, "u", u, wo)
        return Sample(out[..., :3], out[..., 3:6], out[..., 6], out[..., 7] > 0.5)

    def gradient(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """Exact derivatives of f by the parameters.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.

        Returns
        -------
        ndarray of shape (..., 3, P)
            df_c/dp_j in 1/sr per unit of the parameter; `entries` names the P entries.
        """
        wi, wo = _vectors("wi", wi), _vectors("wo", wo)
        count = len(self.entries)
        shape, n, params, first, second = self._inputs(np.dtype(np.float64), wi, wo)
        out = np.empty((n, 3 * count), np.float64)
        _lesk.gradient(self.id, params, first, second, out)
        return _in_type_of((wi, wo), out.reshape(*shape, 3, count))

    def albedo(self, wo: npt.ArrayLike, *, samples: int = 4096, seed: int = 0) -> Array:
        """The directional albedo: the share of light from `wo` that is scattered (Monte Carlo by the model's own draws).

        Parameters
        ----------
        wo : array_like of shape (..., 3)
            Unit vectors, local frame.
        samples : int
            Draws per direction; the standard error falls with its root.
        seed : int
            Seed of the draws.

        Returns
        -------
        ndarray of shape (..., 3)
            Albedo per channel.
        """
        wo = _vectors("wo", wo)
        drawn = self.sample(np.broadcast_to(wo, (samples, *wo.shape)), seed=seed)
        return cast(Array, drawn.weight.mean(axis=0, dtype=np.float64))

    def __repr__(self) -> str:
        return f"lesk.models.{self.id}({', '.join(f'{k}={_short(v)}' for k, v in self._values.items())})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td><code>{spec['name']}</code></td><td>{html.escape(_short(self._values[spec['name']]))}</td>"
            f"<td>{html.escape(spec['unit'])}</td><td>{html.escape(spec['doc'])}</td></tr>"
            for spec in self.info["parameters"]
        )
        return f"<b>{html.escape(self.info['title'])}</b> ({self.info['year']})<table>{rows}</table>"

    def _pairs(self) -> list[tuple[Array, dict[str, Any]]]:
        return [(self._values[spec["name"]], spec) for spec in self.info["parameters"]]

    @staticmethod
    def _leading(value: Array, spec: dict[str, Any]) -> tuple[int, ...]:
        return value.shape[:-1] if spec["kind"] == "color" else value.shape

    def _inputs(
        self, dtype: np.dtype[Any], first: Array, second: Array
    ) -> tuple[tuple[int, ...], int, list[Array], Array, Array]:
        """The common leading shape, its size, the flat parameters, and both vectors with 1 or n rows."""
        leading = [self._leading(value, spec) for value, spec in self._pairs()]
        try:
            shape = np.broadcast_shapes(first.shape[:-1], second.shape[:-1], *leading)
        except ValueError:
            shapes = ", ".join(str(s) for s in (first.shape[:-1], second.shape[:-1], *leading))
            raise ParameterError(f"the leading shapes {shapes} do not broadcast") from None
        n = int(np.prod(shape, dtype=np.int64))
        params: list[Array] = []
        for value, spec in self._pairs():
            channels = [value[..., c] for c in range(spec["length"])] if spec["kind"] == "color" else [value]
            params += [_rows(channel, shape, (), dtype) for channel in channels]
        return shape, n, params, _rows(first, shape, (3,), dtype), _rows(second, shape, (3,), dtype)

    def _batch(self, what: str, width: int, name: str, first: npt.ArrayLike, second: npt.ArrayLike) -> Array:
        a, b = _vectors(name, first), _vectors("wo", second)
        single = a.dtype == np.float32 and b.dtype == np.float32
        dtype = np.dtype(np.float32 if single else np.float64)
        shape, n, params, rows_a, rows_b = self._inputs(dtype, a, b)
        out = np.empty((n, width), dtype)
        run = _lesk.batch_f32 if single else _lesk.batch_f64
        if run(self.id, what, params, rows_a, rows_b, out):
            for label, rows in ((name, rows_a), ("wo", rows_b)):
                if label != "u":
                    _require_unit(label, rows)
        return out.reshape(*shape, width)


def _vectors(name: str, value: npt.ArrayLike) -> Array:
    array = np.asarray(value)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ParameterError(f"`{name}` has shape {array.shape}, but (..., 3) is accepted")
    if array.dtype not in (np.float32, np.float64):
        try:
            array = array.astype(np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"`{name}` holds {array.dtype}, but numbers are accepted") from None
    return cast(Array, array)


def _rows(value: Array, shape: tuple[int, ...], tail: tuple[int, ...], dtype: np.dtype[Any]) -> Array:
    """`value` as contiguous rows: one if it is the same everywhere, else one per element of `shape`."""
    if value.size == int(np.prod(tail, dtype=np.int64)):
        return np.ascontiguousarray(value.reshape(1, *tail) if tail else value.reshape(1), dtype=dtype)
    full = np.broadcast_to(value, shape + tail)
    return np.ascontiguousarray(full, dtype=dtype).reshape(-1, *tail)


def _require_unit(name: str, rows: Array) -> None:
    length = np.linalg.norm(rows.astype(np.float64), axis=-1)
    odd = np.flatnonzero(np.isfinite(length) & (np.abs(length * length - 1) > 1e-4))
    if odd.size:
        i = int(odd[0])
        raise ParameterError(
            f"`{name}` is not of unit length: {odd.size} of {len(rows)} vectors, the first at index {i} has length "
            f"{length[i]:.6g}, but 1 within 5e-5 is accepted\nhint: divide by numpy.linalg.norm({name}, axis=-1, keepdims=True)"
        )


def _checked(value: npt.ArrayLike, spec: dict[str, Any], model: str) -> Array:
    name, (lo, hi) = spec["name"], spec["range"]
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(f"`{name}` is {value!r}, but model `{model}` accepts numbers") from None
    if spec["kind"] == "color" and (array.ndim == 0 or array.shape[-1] != spec["length"]):
        if array.ndim:
            raise ParameterError(
                f"`{name}` has shape {array.shape}, but a colour is one number or has shape (..., {spec['length']})"
            )
        array = np.broadcast_to(array, (spec["length"],))
    bad = ~((array >= lo) & (array <= hi))
    # a value of the float32 border may lie a rounding beyond the border in float64
    bad &= ~(np.isclose(array, lo, rtol=1e-7, atol=0) | np.isclose(array, hi, rtol=1e-7, atol=0))
    if bad.any():
        raise ParameterError(f"`{name}` is {array[bad].flat[0]:g}, but model `{model}` accepts {lo:g} to {hi:g}")
    return np.clip(array, lo, hi)


def _unknown(name: str, model: str, known: list[str]) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name, known, n=1)
    hint = f"\nhint: did you mean `{close[0]}`?" if close else ""
    return f"model `{model}` has no parameter `{name}`; it has {', '.join(f'`{k}`' for k in known)}{hint}"


def _short(value: Array) -> str:
    if value.ndim == 0:
        return f"{value:g}"
    if value.ndim == 1 and value.size == 3:
        return f"{value[0]:g}" if (value == value[0]).all() else "[" + ", ".join(f"{v:g}" for v in value) + "]"
    return f"<array of shape {value.shape}>"


def _in_type_of(inputs: tuple[Array, ...], result: Array) -> Array:
    return result.astype(np.float32) if all(a.dtype == np.float32 for a in inputs) else result
