import gc
from collections.abc import Iterator

import pytest

from service.process.garbage_collection import collection_paused, spare_what_stays


@pytest.fixture(autouse=True)
def nothing_stays_frozen() -> Iterator[None]:
    yield
    gc.unfreeze()


def test_what_was_made_meanwhile_is_not_looked_through_at_the_end() -> None:
    with collection_paused():
        made: list[list[int]] = [[] for _ in range(10)]
    assert gc.get_freeze_count() > len(made)


def test_the_collector_runs_again_afterwards() -> None:
    with collection_paused():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_and_after_a_failure() -> None:
    with pytest.raises(ValueError, match="wrong"), collection_paused():
        raise ValueError("wrong")
    assert gc.isenabled()


def test_one_that_was_off_stays_off() -> None:
    gc.disable()
    try:
        with collection_paused():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_a_service_looks_through_its_libraries_no_more() -> None:
    spare_what_stays()
    assert gc.isenabled()
    assert len(gc.get_objects()) < gc.get_freeze_count() / 10
