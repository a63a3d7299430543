"""Minimax coefficients of `crates/lesk-math/src/poly.rs`.

Run `python3 make.py > ../../crates/lesk-math/src/poly/table.rs` and `cargo fmt` (needs numpy and mpmath; made with 2.4.6 and
1.4.1). It prints one Rust table per function together with the largest relative error of the rounded coefficients in
exact arithmetic. The rounding errors of the evaluation come on top and are measured by `crates/lesk-math/tests/poly.rs`.

Method: Lawson's iteration (weighted least squares whose weights grow where the error is large) gives the minimax fit.
After each fit the lowest free coefficient, which matters most, is rounded to `f32` and frozen, and the rest is fitted
again, so that later coefficients absorb its rounding. A rational form P/Q is found by iterating the linear fit of
P - f (Q - 1) with the denominator of the previous round as weight (Loeb); P is then fitted to the rounded Q.
"""

import numpy as np
from mpmath import acos, atan, erf, erfinv, exp, log, mp, mpf, pi, sin, sqrt

mp.dps = 40
POINTS = 800


def grid(lo, hi):
    """Chebyshev points of [lo, hi]."""
    k = np.arange(POINTS)
    return (lo + hi) / 2 - (hi - lo) / 2 * np.cos(np.pi * (k + 0.5) / POINTS)


def lawson(columns, target, scale, rounds=300):
    """Coefficients that minimise max |columns @ c - target| * scale."""
    norms = np.abs(columns * scale[:, None]).max(axis=0)
    a, b = columns * scale[:, None] / norms, target * scale
    weights = np.full(len(b), 1 / len(b))
    best, best_error = None, np.inf
    for _ in range(rounds):
        root = np.sqrt(weights)
        c = np.linalg.lstsq(a * root[:, None], b * root, rcond=None)[0]
        error = np.abs(a @ c - b)
        if error.max() < best_error:
            best, best_error = c, error.max()
        weights = weights * (error + 1e-3 * error.max())
        weights /= weights.sum()
    return best / norms


def rounded_fit(columns, target, scale, frozen=()):
    """Fit, freeze the lowest free coefficient at its f32 value, repeat."""
    c = [float(v) for v in frozen]
    while len(c) < columns.shape[1]:
        done = len(c)
        rest = lawson(columns[:, done:], target - columns[:, :done] @ np.array(c), scale)
        c.append(float(np.float32(rest[0])))
    return np.array(c)


def show(name, function, error, c):
    print(f"\n/// `{function}`; relative error {error:.1e} before the rounding of the evaluation.")
    print(f"pub const {name}: [f64; {len(c)}] = [")
    for v in c:
        print(f"    {float(v)!r},")
    print("];")


def tabulate(function, lo, hi):
    x = grid(float(lo), float(hi))
    return x, np.array([float(function(mpf(v))) for v in x])


def polynomial(name, text, function, degree, lo, hi, frozen=(), skip=0):
    """Relative minimax fit of `function` by a polynomial of the given degree; the first `skip` coefficients are not shown."""
    x, f = tabulate(function, lo, hi)
    columns = x[:, None] ** np.arange(degree + 1)
    c = rounded_fit(columns, f, 1 / np.abs(f), frozen)
    worst = np.abs(columns @ c / f - 1).max()
    show(name, f"{text} on [{float(lo):.4}, {float(hi):.4}]", worst, c[skip:])


def rational(name, text, function, degree, lo, hi):
    """Relative minimax fit of `function` by P/Q of equal degree, with Q(0) = 1."""
    x, f = tabulate(function, lo, hi)
    p_columns = x[:, None] ** np.arange(degree + 1)
    q_columns = p_columns[:, 1:]
    both = np.hstack([p_columns, -f[:, None] * q_columns])
    q = np.ones_like(x)
    for _ in range(30):
        c = lawson(both, f, 1 / np.abs(f * q), rounds=100)
        q = 1 + q_columns @ c[degree + 1 :]
    q_rounded = c[degree + 1 :].astype(np.float32).astype(float)
    q = 1 + q_columns @ q_rounded
    p = rounded_fit(p_columns, f * q, 1 / np.abs(f * q))
    worst = np.abs(p_columns @ p / q / f - 1).max()
    text = f"{text} on [{float(lo):.4}, {float(hi):.4}]"
    show(name + "_P", "numerator of " + text, worst, p)
    show(name + "_Q", "denominator of " + text, worst, np.concatenate([[1.0], q_rounded]))


def inverse_erf(w):
    """erf_inv(x) / x as a function of w = -log2(1 - x^2)."""
    x = sqrt(1 - mpf(2) ** -w)
    return erfinv(x) / x


def main():
    ln2, root = log(2), sqrt(mpf(2))
    half_pi = pi / 2 * mpf("1.001")
    print(
        "//! Minimax coefficients in ascending powers, as `data/poly/make.py` prints them. Every entry is an exact `f32`."
    )
    polynomial("EXP2", "2^x", lambda x: 2**x, 6, -0.5, 0.5, [1], skip=1)
    polynomial("EXP", "e^x", exp, 6, -ln2 / 2 * 1.001, ln2 / 2 * 1.001, [1, 1], skip=1)
    polynomial("LOG2", "log2(1 + t) / t", lambda t: log(1 + t) / ln2 / t, 8, 1 / root - 1, root - 1)
    polynomial("SIN", "sin(sqrt z) / sqrt z", lambda z: sin(sqrt(z)) / sqrt(z), 4, 0, half_pi**2, [1], skip=1)
    polynomial("ACOS", "acos(x) / sqrt(1 - x)", lambda x: acos(x) / sqrt(1 - x), 8, 0, 1)
    polynomial("ATAN", "atan(sqrt z) / sqrt z", lambda z: atan(sqrt(z)) / sqrt(z), 9, 0, 1, [1])
    rational("ERF", "erf(sqrt z) / sqrt z", lambda z: erf(sqrt(z)) / sqrt(z), 5, 0, mpf("3.92") ** 2)
    rational("ERF_INV", "erf_inv(x) / x over w = -log2(1 - x^2)", inverse_erf, 5, 0, mpf("23.1"))


if __name__ == "__main__":
    main()
