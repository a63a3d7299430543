"""Where results go: `out`, layouts, memory that is used again. Expected values are those of a plain call on copies."""

from __future__ import annotations

import numpy as np
import pytest

import lesk
from lesk import _outputs

MODEL = lesk.models.ggx(alpha_x=0.3, alpha_y=0.5)
# above the size from which results go past the caches, and no multiple of a block
MANY = (1 << 18) + 77


def directions(n, seed, dtype=np.float32):
    rng = np.random.default_rng(seed)
    z, phi = rng.uniform(0.05, 1, n), rng.uniform(0, 2 * np.pi, n)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).astype(dtype)


def planar(vectors):
    return np.moveaxis(np.ascontiguousarray(np.moveaxis(vectors, -1, 0)), 0, -1)


def assert_same(one, other):
    for a, b in zip(one, other, strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("n", [1, 5, 1000, MANY])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_per_component_give_the_same_values_in_their_own_layout(n, dtype):
    n = min(n, 20_000) if dtype is np.float64 else n
    wi, wo, u = directions(n, 0, dtype), directions(n, 1, dtype), np.random.default_rng(2).random((n, 3), dtype)
    by_rows = [MODEL.eval(wi, wo), MODEL.pdf(wi, wo), *MODEL.sample(wo, u)]
    wi, wo, u = planar(wi), planar(wo), planar(u)
    drawn = MODEL.sample(wo, u)
    by_planes = [MODEL.eval(wi, wo), MODEL.pdf(wi, wo), *drawn]
    assert_same(by_rows, by_planes)
    if n > 1:
        assert all(a.T.flags.c_contiguous for a in (by_planes[0], drawn.wi, drawn.weight))


def test_a_layout_of_several_leading_axes_is_kept():
    wi, wo = planar(directions(60, 0).reshape(3, 4, 5, 3)), planar(directions(60, 1).reshape(3, 4, 5, 3))
    f = MODEL.eval(wi, wo)
    assert np.moveaxis(f, -1, 0).flags.c_contiguous
    assert np.array_equal(f, MODEL.eval(np.ascontiguousarray(wi), np.ascontiguousarray(wo)))


@pytest.mark.parametrize("offset", range(0, 17, 4))
def test_results_do_not_depend_on_where_out_lies(offset):
    wi, wo = directions(MANY, 0), directions(MANY, 1)
    memory = np.zeros(3 * MANY + 32, np.float32)
    out = memory[offset // 4 :][: 3 * MANY].reshape(MANY, 3)
    assert MODEL.eval(wi, wo, out=out) is out
    assert np.array_equal(out, MODEL.eval(wi, wo))
    assert not memory[: offset // 4].any() and not memory[offset // 4 + 3 * MANY :].any()


@pytest.mark.parametrize(
    "make",
    [
        lambda n: np.empty((n, 3), np.float32),
        lambda n: np.empty((3, n), np.float32).T,
        lambda n: np.empty((n, 6), np.float32)[:, ::2],
        lambda n: np.empty((n, 3), np.float32)[::-1],
        lambda n: np.empty(12 * n + 1, np.uint8)[1:].view(np.float32).reshape(n, 3),
    ],
    ids=["rows", "planes", "strided", "backwards", "unaligned"],
)
def test_out_of_any_layout_is_filled(make):
    wi, wo = directions(3000, 0), directions(3000, 1)
    out = make(3000)
    assert MODEL.eval(wi, wo, out=out) is out
    assert np.array_equal(out, MODEL.eval(wi, wo))


def test_out_may_share_memory_with_an_input():
    wi, wo = directions(3000, 0), directions(3000, 1)
    expected = MODEL.eval(wi, wo)
    both = np.concatenate([wi, np.zeros((1, 3), np.float32)])
    MODEL.eval(both[:-1], wo, out=both[1:])
    assert np.array_equal(both[1:], expected)
    MODEL.eval(wi, wo, out=wi)
    assert np.array_equal(wi, expected)


def test_draws_go_to_the_arrays_of_an_earlier_draw():
    first, second = directions(3000, 0), directions(3000, 1)
    drawn = MODEL.sample(first)
    arrays = tuple(drawn)
    again = MODEL.sample(second, out=drawn)
    assert all(a is b for a, b in zip(arrays, again, strict=True))
    assert_same(again, MODEL.sample(second))
    shared = np.empty((3000, 3), np.float32)
    drawn = MODEL.sample(first, out=(shared, shared, None, None))
    assert np.array_equal(shared, MODEL.sample(first).weight)  # the later of two outputs in one array


ROWS = directions(4, 0)


@pytest.mark.parametrize(
    ("out", "text"),
    [
        (np.empty((4, 4), np.float32), "`out` has shape (4, 4), but the result has shape (4, 3)"),
        (np.empty((2, 3), np.float32), "`out` has shape (2, 3), but the result has shape (4, 3)"),
        (np.empty((4, 3)), "`out` is an array of float64, but the result is float32\nhint: float32 directions"),
        (np.empty((4, 3), np.int32), "`out` is an array of int32"),
        ([[0.0] * 3] * 4, "`out` is a list, but an array of NumPy is accepted"),
        (np.broadcast_to(np.float32(0), (4, 3)), "`out` cannot be written: it is read-only"),
    ],
    ids=["columns", "rows", "float64", "int32", "list", "read-only"],
)
def test_an_out_that_does_not_fit_is_an_error_that_says_what_does(out, text):
    with pytest.raises(lesk.ParameterError) as error:
        MODEL.eval(ROWS, ROWS, out=out)
    assert text in str(error.value)


def test_an_out_of_draws_that_does_not_fit_is_named():
    with pytest.raises(lesk.ParameterError, match=r"`out.delta` is an array of float32, but the result is bool$"):
        MODEL.sample(ROWS, out=(None, None, None, np.empty(4, np.float32)))
    with pytest.raises(lesk.ParameterError, match="`out` has 2 arrays, but 4 are accepted"):
        MODEL.sample(ROWS, out=(None, None))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("wrong", [1.0, -0.5, np.nan])
def test_numbers_outside_the_unit_interval_are_an_error(dtype, wrong):
    u = np.full((4, 3), 0.5, dtype)
    u[2, 1] = wrong
    with pytest.raises(lesk.ParameterError, match=r"`u` holds .*, but numbers from 0 to below 1 are accepted"):
        MODEL.sample(ROWS.astype(dtype), u)


def test_memory_of_a_result_is_used_again_once_nobody_holds_it():
    wi, wo = directions(MANY, 0), directions(MANY, 1)
    first = MODEL.eval(wi, wo)
    expected, place = first.copy(), first.ctypes.data
    assert place % 64 == 0
    second = MODEL.eval(wo, wi)
    assert not np.may_share_memory(first, second)
    view = first[5:7, 1]
    del first
    third = MODEL.eval(wo, wi)
    # a view keeps the whole
    assert not np.may_share_memory(view, third) and np.array_equal(view, expected[5:7, 1])
    del view
    assert MODEL.eval(wi, wo).ctypes.data == place


def test_the_pool_is_bounded():
    pool = _outputs._Pool()
    for k in range(8):
        pool.give(np.empty(_outputs._POOL_LIMIT // 4 + k, np.uint8))
    assert 0 < sum(memory.size for memory in pool._free) <= _outputs._POOL_LIMIT
    pool.give(np.empty(_outputs._POOL_LIMIT + 1, np.uint8))
    assert not pool._free
