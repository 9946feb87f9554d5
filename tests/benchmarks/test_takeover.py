"""The benchmark of take-overs: what it does not let pass."""

import pytest

from benchmarks.takeover.hosts import require_once


def test_each_once_is_fine() -> None:
    require_once("record stored", ["A", "B"], {"A": 1, "B": 1})


@pytest.mark.parametrize(("found", "words"), [({"A": 1}, "'B': 0"), ({"A": 1, "B": 2}, "'B': 2")])
def test_what_is_lost_or_doubled_is_named(found: dict[str, int], words: str) -> None:
    with pytest.raises(AssertionError, match=f"expected each record stored once, found .*{words}"):
        require_once("record stored", ["A", "B"], found)
