"""Models over arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, Self, cast

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk._arrays import Array, leading_shape, numbers, require_directions, result_type, spread, vectors
from lesk._outputs import Output, is_planar, output
from lesk.errors import ParameterError, nearest, quoted

# now, or the first call would wait for it
_lesk.find_numpy()

_ALBEDO_BLOCK = 1 << 20
"""Draws at a time when an albedo is estimated: bounds the memory."""


_FlatSample = tuple[Array, Array, Array, npt.NDArray[np.bool_]]


class Sample(NamedTuple):
    """Directions drawn by `Model.sample`, with arrays of the broadcast leading shape."""

    wi: Array
    """Unit vectors to the light, shape (..., 3)."""
    weight: Array
    """f times the cosine of `wi` over pdf per channel, shape (..., 3); 0 for a failed draw."""
    pdf: Array
    """Density in 1/sr, or the probability of a delta lobe, shape (...); 0 for a failed draw."""
    delta: npt.NDArray[np.bool_]
    """Whether a delta lobe was taken, shape (...)."""


class Delta(NamedTuple):
    """The delta lobes of `Model.delta`: at most two per direction; all 0 where there is none."""

    wi: Array
    """Unit vectors to the light, shape (..., 2, 3)."""
    weight: Array
    """Share of the radiance from `wi` that reaches `wo` per channel, shape (..., 2, 3)."""
    probability: Array
    """How often `sample` takes the lobe, shape (..., 2)."""


class Model:
    """A scattering model with its parameters.

    Directions are unit vectors of shape (..., 3) in the local frame (normal +z, tangent +x) and leave the surface:
    `wi` to the light, `wo` to the viewer. Leading shapes of directions and parameters broadcast. float32 directions
    give float32 results, whatever the type of the parameters; anything else is computed and returned in float64.
    Directions whose components lie in arrays of their own (`xyz.T` of shape (N, 3) from `xyz` of shape (3, N)) are read
    in place, and give results of the same layout. Python's lock is released while a method computes.
    """

    id: ClassVar[str] = ""
    """The name used everywhere: Python, command line, scene files."""
    info: ClassVar[Mapping[str, Any]] = {}
    """Title, year, paper, domain, parameters and claims, as `lesk models --json` prints them."""

    def __init__(self, **parameters: npt.ArrayLike) -> None:
        if not self.id:
            raise TypeError("`Model` is the base of the classes in `lesk.models`")
        specs = {spec["name"]: spec for spec in self.info["parameters"]}
        for name in parameters:
            if name not in specs:
                hint = nearest(name, specs) or f"\nhint: it has {quoted(specs)}"
                raise ParameterError(f"model `{self.id}` has no parameter `{name}`{hint}")
        self._values = {
            name: _checked(parameters.get(name, spec["default"]), spec, self.id) for name, spec in specs.items()
        }
        self._leading: dict[str, tuple[int, ...]] = {}
        self._flat: list[Array] = []
        for name, spec in specs.items():
            value = self._values[name]
            if spec["kind"] != "color":
                value = value[..., np.newaxis]
            self._leading[name] = value.shape[:-1]
            self._flat += [value[..., c : c + 1] for c in range(spec["length"])]

    @property
    def params(self) -> Mapping[str, Array]:
        """The parameters by name: shape (...) for numbers, (..., 3) for colours. They cannot be changed; see `replace`."""
        return MappingProxyType(self._values)

    @property
    def entries(self) -> list[str]:
        """Names of the P entries of the flat parameter table: the last axis of `gradient`."""
        return list(self.info["entries"])

    def replace(self, **parameters: npt.ArrayLike) -> Self:
        """Make the same model with some parameters changed.

        Parameters
        ----------
        **parameters : array_like
            New values by name.

        Returns
        -------
        Model
            A new model; this one stays as it is.

        Examples
        --------
        >>> import lesk
        >>> lesk.models.ggx(alpha_x=0.1).replace(alpha_y=0.3)
        lesk.models.ggx(f0=1, alpha_x=0.1, alpha_y=0.3)
        """
        return type(self)(**{**self._values, **parameters})

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, out: Array | None = None) -> Array:
        """Evaluate the BSDF f(wi, wo), continuous part, without the cosine.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.
        out : ndarray of shape (..., 3), optional
            Where the result goes: an array of the result's shape and type. An array of another memory layout than the
            result's, or one that shares memory with an input, is filled through a temporary one.

        Returns
        -------
        ndarray of shape (..., 3)
            f in 1/sr per channel; 0 outside the model's domain and for directions that are not finite. It is `out`, if
            that is given.

        Raises
        ------
        ParameterError
            If a direction is not of unit length, shapes do not broadcast, or `out` does not fit.

        Examples
        --------
        >>> import lesk
        >>> lesk.models.lambert(reflectance=0.5).eval([0, 0, 1], [0.6, 0, 0.8]).round(6).tolist()
        [0.159155, 0.159155, 0.159155]
        """
        return self._evaluate("eval", (3,), wi, wo, out)

    def pdf(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, out: Array | None = None) -> Array:
        """Compute the density with which `sample` draws `wi` given `wo`, continuous part.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.
        out : ndarray of shape (...), optional
            Where the result goes: an array of the result's shape and type. An array of another memory layout than the
            result's, or one that shares memory with an input, is filled through a temporary one.

        Returns
        -------
        ndarray of shape (...)
            Density in 1/sr of solid angle over `wi`. It is `out`, if that is given.

        Raises
        ------
        ParameterError
            If a direction is not of unit length, shapes do not broadcast, or `out` does not fit.
        """
        return self._evaluate("pdf", (), wi, wo, out)

    def sample(
        self,
        wo: npt.ArrayLike,
        u: npt.ArrayLike | None = None,
        *,
        seed: int = 0,
        out: Sample | tuple[Array | None, ...] | None = None,
    ) -> Sample:
        """Draw directions to the light.

        Parameters
        ----------
        wo : array_like of shape (..., 3)
            Unit vectors to the viewer, local frame.
        u : array_like of shape (..., 3), optional
            Numbers in [0, 1); the third chooses a lobe. Without them, draw i takes the numbers that belong to `seed`
            and i, and there is one draw per element of the leading shape of `wo` and the parameters.
        seed : int
            Seed of the random numbers, 0 to 2^64 - 1; not used with `u`.
        out : Sample or tuple of four arrays, optional
            Where the results go, for instance an earlier result; see `eval`.

        Returns
        -------
        Sample
            Named tuple `(wi, weight, pdf, delta)`.

        Raises
        ------
        ParameterError
            If a direction is not of unit length, numbers are outside [0, 1), shapes do not broadcast, or an array of
            `out` does not fit.

        Examples
        --------
        >>> import lesk, numpy as np
        >>> wi, weight, pdf, delta = lesk.models.mirror(reflectance=0.9).sample([0.6, 0.0, 0.8])
        >>> (wi + 0.0).tolist(), weight.tolist(), bool(delta)
        ([-0.6, 0.0, 0.8], [0.9, 0.9, 0.9], True)
        """
        wo = vectors("wo", wo)
        given = {} if u is None else {"u": vectors("u", u)}
        shape = self._shape(wo=wo, **given)
        inputs = (wo, *given.values())
        dtype, planar = result_type(*inputs), is_planar(inputs)
        if not 0 <= seed < 1 << 64:
            raise ParameterError(f"`seed` is {seed}, but 0 to 2^64 - 1 is accepted")
        targets = (None,) * len(Sample._fields) if out is None else tuple(out)
        if len(targets) != len(Sample._fields):
            raise ParameterError(f"`out` has {len(targets)} arrays, but {len(Sample._fields)} are accepted")
        results: list[Output] = []
        for name, target in zip(Sample._fields, targets, strict=True):
            tail = (3,) if name in ("wi", "weight") else ()
            kind = np.dtype(np.bool_) if name == "delta" else dtype
            earlier = (result.flat for result in results)
            results.append(output(f"out.{name}", shape, tail, kind, planar, target, (*inputs, *earlier)))
        spread_u = spread(given["u"], shape) if given else None
        flat = cast(_FlatSample, tuple(result.flat for result in results))
        if _lesk.draw(self.id, self._parameters(shape), spread_u, spread(wo, shape), int(seed), flat, planar):
            _require_unit_interval(**given)
            require_directions(wo=wo)
        return Sample(*(result.deliver() for result in results))

    def delta(self, wo: npt.ArrayLike) -> Delta:
        """Give the delta lobes: mirror reflection and refraction, which `eval` and `pdf` do not contain.

        Parameters
        ----------
        wo : array_like of shape (..., 3)
            Unit vectors to the viewer, local frame.

        Returns
        -------
        Delta
            Named tuple `(wi, weight, probability)`; all 0 where there is no lobe.
        """
        wo = vectors("wo", wo)
        shape = self._shape(wo=wo)
        out = np.empty((*shape, 2, 7), result_type(wo))
        if _lesk.delta(self.id, self._parameters(shape), spread(wo, shape), out.reshape(-1)):
            require_directions(wo=wo)
        return Delta(out[..., :3], out[..., 3:6], out[..., 6])

    def gradient(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """Compute exact derivatives of f by the parameters.

        Parameters
        ----------
        wi, wo : array_like of shape (..., 3)
            Unit vectors to the light and to the viewer, local frame.

        Returns
        -------
        ndarray of shape (..., 3, P)
            df_c/dp_j in 1/sr per unit of the parameter; `entries` names the P entries. It is computed in float64.

        Raises
        ------
        ParameterError
            If a direction is not of unit length, or shapes do not broadcast.

        Examples
        --------
        >>> import lesk
        >>> model = lesk.models.lambert(reflectance=0.5)
        >>> model.entries
        ['reflectance.r', 'reflectance.g', 'reflectance.b']
        >>> model.gradient([0, 0, 1], [0, 0, 1])[0].round(6).tolist()  # 1/pi for red only
        [0.31831, 0.0, 0.0]
        """
        wi, wo = vectors("wi", wi), vectors("wo", wo)
        shape = self._shape(wi=wi, wo=wo)
        out = np.empty((*shape, 3, len(self._flat)), result_type(wi, wo))
        inputs = (self._parameters(shape), spread(wi, shape), spread(wo, shape))
        if _lesk.gradient(self.id, *inputs, out.reshape(-1)):
            require_directions(wi=wi, wo=wo)
        return out

    def albedo(self, wo: npt.ArrayLike, *, samples: int = 4096, seed: int = 0) -> Array:
        """Estimate the directional albedo: the share of light from `wo` that is scattered, delta lobes included.

        Parameters
        ----------
        wo : array_like of shape (..., 3)
            Unit vectors, local frame.
        samples : int
            Draws per direction, from a scrambled Sobol sequence. The error is about 1e-4 with 4096.
        seed : int
            Seed of the scrambling.

        Returns
        -------
        ndarray of shape (..., 3)
            Albedo per channel, dimensionless.

        Examples
        --------
        >>> import lesk
        >>> lesk.models.lambert(reflectance=[0.2, 0.5, 0.8]).albedo([0, 0, 1]).round(4).tolist()
        [0.2, 0.5, 0.8]
        """
        wo = vectors("wo", wo)
        if not 1 <= samples < 1 << 32:
            raise ParameterError(f"`samples` is {samples}, but 1 to 2^32 - 1 is accepted")
        shape = self._shape(wo=wo)
        dtype = result_type(wo)
        total = np.zeros((*shape, 3), np.float64)
        block = max(1, _ALBEDO_BLOCK // max(1, total.size // 3))
        for start in range(0, samples, block):
            points = _lesk.sobol(start, min(block, samples - start), seed & 0xFFFF_FFFF)
            u = points.reshape(-1, *(1,) * len(shape), 3).astype(dtype, copy=False)
            total += self.sample(wo, u).weight.sum(axis=0, dtype=np.float64)
        return (total / samples).astype(dtype)

    def shader(
        self,
        language: str,
        *,
        parts: Sequence[str] = ("eval", "pdf", "sample"),
        math: str = "builtin",
        complete: bool = False,
    ) -> str | bytes:
        """Write the model as shader source; parameters are arguments there, their values here do not matter.

        Parameters
        ----------
        language : str
            `glsl-es` (3.00), `glsl` (4.50), `wgsl`, `hlsl`, `msl` or `spirv`.
        parts : sequence of str
            Which functions: `eval`, `pdf`, `sample`, `draw`.
        math : str
            `builtin` uses the target's exponentials and trigonometry, `exact` Lesk's own polynomials.
        complete : bool
            A complete fragment shader instead of functions to paste.

        Returns
        -------
        str or bytes
            The source; bytes for `spirv`.

        Examples
        --------
        >>> import lesk
        >>> "fn lambert_eval" in lesk.models.lambert().shader("wgsl")
        True
        """
        from lesk._shader import export

        return export(self.id, language, parts=parts, math=math, complete=complete)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={_short(value)}" for name, value in self._values.items())
        return f"lesk.models.{self.id}({values})"

    def _repr_html_(self) -> str:
        from lesk._html import describe

        return describe(self)

    def _shape(self, **named: Array) -> tuple[int, ...]:
        """Broadcast the leading shapes of vectors and parameters."""
        return leading_shape({**{name: a.shape[:-1] for name, a in named.items()}, **self._leading})

    def _parameters(self, shape: tuple[int, ...]) -> list[Array]:
        return [spread(entry, shape) for entry in self._flat]

    def _evaluate(
        self, what: str, tail: tuple[int, ...], wi: npt.ArrayLike, wo: npt.ArrayLike, out: Array | None
    ) -> Array:
        wi, wo = vectors("wi", wi), vectors("wo", wo)
        shape = self._shape(wi=wi, wo=wo)
        planar = is_planar((wi, wo))
        result = output("out", shape, tail, result_type(wi, wo), planar, out, (wi, wo))
        inputs = (self._parameters(shape), spread(wi, shape), spread(wo, shape))
        if _lesk.evaluate(self.id, what, *inputs, result.flat, planar):
            require_directions(wi=wi, wo=wo)
        return result.deliver()


def _require_unit_interval(**named: Array) -> None:
    for name, u in named.items():
        # negated, so that NaN is caught
        if u.size and not (u.min() >= 0 and u.max() < 1):
            wrong = u[~((u >= 0) & (u < 1))].flat[0]
            raise ParameterError(f"`{name}` holds {wrong:g}, but numbers from 0 to below 1 are accepted")


def _checked(value: npt.ArrayLike, spec: Mapping[str, Any], model: str) -> Array:
    """Copy a parameter and check its shape and range."""
    name, (lo, hi) = spec["name"], spec["range"]
    array = numbers(name, value).copy()
    if spec["kind"] == "color" and (array.ndim == 0 or array.shape[-1] != spec["length"]):
        if array.ndim:
            raise ParameterError(
                f"`{name}` has shape {array.shape}, but a colour of model `{model}` is one number or has shape "
                f"(..., {spec['length']})"
            )
        array = np.full(spec["length"], array)
    # a border that was rounded to float32 may lie beyond itself in float64
    slack = 1e-7
    bad = ~((array >= lo - slack * abs(lo)) & (array <= hi + slack * abs(hi)))
    if bad.any():
        given = array[bad].flat[0]
        raise ParameterError(f"`{name}` is {given:g}, but model `{model}` accepts {lo:g} to {hi:g}")
    np.clip(array, lo, hi, out=array)
    array.flags.writeable = False
    return array


def _short(value: Array) -> str:
    if value.ndim == 0:
        return f"{value:g}"
    if value.ndim == 1 and value.size == 3:
        same = (value == value[0]).all()
        return f"{value[0]:g}" if same else "[" + ", ".join(f"{v:g}" for v in value) + "]"
    return f"<array of shape {value.shape}>"
