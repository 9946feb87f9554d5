"""Parameters that are followed, on the page of a motor."""

import json

import httpx
import pytest

from core.tracking.follower import REFERENCE_RECORDS
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.following import Recorder, fold_all
from testing.service.plants import motor
from testing.service.tracked_records import tracked_records
from tests.service.web.motor.recorded import MOTOR, know
from tests.service.web.pages import page, words

HERE = f"/motors/{MOTOR}/nameplate?days=all"
WRONG_FROM = REFERENCE_RECORDS + 5


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    know(repository)
    return Recorder(repository, store)


def test_what_no_record_tells_is_said(client: httpx.Client, recorder: Recorder) -> None:
    del recorder
    document = page(client.get(HERE))
    assert words(document, "#parameters .sentence") == ["not assessed No record tells of the parameters yet."]


def test_a_drift_is_told_in_words_and_drawn_with_its_interval(
    client: httpx.Client, recorder: Recorder, repository: Repository
) -> None:
    recorder.record_all(tracked_records(motor(MOTOR).parameters, WRONG_FROM + 12, wrong_from=WRONG_FROM))
    fold_all(repository)
    document = page(client.get(HERE))
    (sentence,) = words(document, "#parameters .sentence")
    assert sentence.startswith("drifting Parameters have drifted: ")
    assert "a CT or VT ratio changed" in sentence
    (found,) = document.cssselect("#parameter-magnetising-inductance-data")
    chart = json.loads(found.text_content())
    assert len(chart["x"]["values"]) == WRONG_FROM + 12 - REFERENCE_RECORDS + 1
