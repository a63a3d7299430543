"""Comparing two renderers by the means of tiles.

Each renderer makes several pictures with independent seeds. The mean of a tile over these pictures has a standard error
that comes from their scatter alone, so nothing is assumed about the samples inside a picture (stratified or not).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

# both sum in f32 somewhere: Mitsuba 64 samples of a pixel, each rounded at 6e-8
ROUNDING = 1e-5


@dataclass(frozen=True)
class TileMeans:
    """Means of tiles: `mean` and `variance` (of that mean) have the shape (tiles, 3)."""

    mean: np.ndarray
    variance: np.ndarray
    pictures: int

    @staticmethod
    def of(pictures: list[np.ndarray], side: int) -> TileMeans:
        """Tiles of `side` pixels, row by row, from pictures (h, w, 3) made with independent seeds."""
        stack = np.stack([tile_means(np.asarray(p, np.float64), side) for p in pictures])
        n = len(pictures)
        return TileMeans(stack.mean(0), stack.var(0, ddof=1) / n, n)

    def whole(self) -> TileMeans:
        """The picture as one tile; tiles are independent."""
        n = len(self.mean)
        return TileMeans(self.mean.mean(0, keepdims=True), self.variance.sum(0, keepdims=True) / n**2, self.pictures)

    def relative_error(self) -> float:
        """Standard error of the green mean of the picture, relative to it."""
        whole = self.whole()
        return float(np.sqrt(whole.variance[0, 1]) / whole.mean[0, 1])


def tile_means(picture: np.ndarray, side: int) -> np.ndarray:
    """Means of tiles (tiles, 3) of a picture (h, w, 3)."""
    h, w, c = picture.shape
    return picture.reshape(h // side, side, w // side, side, c).mean((1, 3)).reshape(-1, c)


def z_scores(a: TileMeans, b: TileMeans) -> np.ndarray:
    """Difference of every tile in standard errors, (tiles, 3).

    Welch's statistic; its Student distribution is turned into a normal one by Wallace's approximation (1959).
    Tiles that are black in both are 0.
    """
    error2 = a.variance + b.variance + (ROUNDING * np.maximum(a.mean, b.mean)) ** 2
    t = np.divide(a.mean - b.mean, np.sqrt(error2), out=np.zeros_like(error2), where=error2 > 0)
    spread = a.variance**2 / (a.pictures - 1) + b.variance**2 / (b.pictures - 1)
    nu = np.divide(error2**2, spread, out=np.full_like(spread, 1e6), where=spread > 0)
    nu = np.minimum(nu, 1e6)
    return np.sign(t) * (8 * nu + 1) / (8 * nu + 3) * np.sqrt(nu * np.log1p(t * t / nu))


def z_of_scatter(z: np.ndarray) -> np.ndarray:
    """Sums of squares of the scores of all tiles, per channel, as normal numbers (Wilson & Hilferty 1931)."""
    n = len(z)
    return (np.cbrt((z**2).mean(0)) - (1 - 2 / (9 * n))) / math.sqrt(2 / (9 * n))


def sidak_limit(tests: int, alpha: float) -> float:
    """The |z| that all of `tests` independent tests stay below with probability 1 - alpha."""
    single = -math.expm1(math.log1p(-alpha) / tests)
    return NormalDist().inv_cdf(1 - single / 2)
