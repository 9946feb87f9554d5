"""Every test of the storage runs on both databases, unless it says that it is about one of them."""

from collections.abc import Iterator

import pytest

from service.storage.states import JobState, RecordingRequestState, RecordingState
from tests.service.fixtures import database_url_of_each as database_url
from tests.service.fixtures import engine, repository, standing_alarm_counts, state_counts, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture(autouse=True)
def the_state_counts_are_right(request: pytest.FixtureRequest) -> Iterator[None]:
    """Whatever a test has done, the counts that are kept are those of the tables."""
    if "repository" not in request.fixturenames:
        yield
        return
    engine = request.getfixturevalue("engine")
    yield
    kept, counted = state_counts(engine)
    assert kept == counted
    kept_alarms, standing_alarms = standing_alarm_counts(engine)
    assert kept_alarms == standing_alarms
    assert set(kept) == {
        *(("recordings", state.value) for state in RecordingState),
        *(("recording_requests", state.value) for state in RecordingRequestState),
        *(("jobs", state.value) for state in JobState),
    }
