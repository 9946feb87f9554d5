"""Who watches is told of each function that is compiled, and of none that is ready."""

from collections.abc import Iterator
from contextlib import contextmanager

import numba

import core.warm_up  # noqa: F401 - with all functions that are compiled
from core.machines.compile_watch import watched


def test_each_compilation_is_told_while_it_lasts_and_none_afterwards() -> None:
    told: list[tuple[int, int]] = []
    under_way: list[bool] = []

    @contextmanager
    def watch(ready: int, of: int) -> Iterator[None]:
        told.append((ready, of))
        under_way.append(True)
        yield
        under_way.append(False)

    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) * 2)
    with watched(watch):
        assert outer(2) == 6
        assert under_way == [True, False], "what it calls is compiled with it"
        assert outer(3) == 8
        assert under_way == [True, False], "it is ready"
        ((ready, of),) = told
        assert 0 <= ready <= of
        assert of > 30, "those of the machine models"
        assert outer(1.5) == 5.0
    assert under_way == [True, False] * 2
    assert numba.njit(lambda x: x - 1)(1) == 0
    assert len(told) == 2, "nobody watches any more"
