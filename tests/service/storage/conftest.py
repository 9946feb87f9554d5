from collections.abc import Iterator

import pytest
from sqlalchemy import Engine

from service.storage.states import JobState, RecordingRequestState, RecordingState
from tests.service.fixtures import database_url, engine, repository, state_counts, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture(autouse=True)
def the_state_counts_are_right(engine: Engine) -> Iterator[None]:
    """Whatever a test has done, the counts that are kept are those of the tables."""
    yield
    kept, counted = state_counts(engine)
    assert kept == counted
    assert set(kept) == {
        *(("recordings", state.value) for state in RecordingState),
        *(("recording_requests", state.value) for state in RecordingRequestState),
        *(("jobs", state.value) for state in JobState),
    }
