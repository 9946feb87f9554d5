"""The one answer on the page of a motor, and on that of a recording."""

import httpx
import pytest

from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.answers import answer_of, turns_or_joint
from testing.service.rotor_and_supply import BROKEN_ROTOR, SOUND_ROTOR, ExaminedRecordings
from tests.service.web.motor.recorded import MOTOR, know
from tests.service.web.pages import page, words

HERE = f"/motors/{MOTOR}/stator"


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    know(repository)
    return ExaminedRecordings(repository, store)


def test_a_motor_of_which_nothing_is_known_is_told_so(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    document = page(client.get(HERE))
    assert words(document, "#answer .sentence") == ["Not assessed."]


def test_likelihoods_are_bars_with_words(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    for _ in range(3):
        recorded.add(BROKEN_ROTOR, classification=answer_of(pulsation=-3.0, eccentricity=-3.0))
    document = page(client.get(HERE))
    assert words(document, "#answer .sentence")[0].startswith("Uneven rotor (")
    (bar,) = document.cssselect("#answer meter")
    assert bar.get("aria-label") == "uneven rotor"
    assert int(bar.get("value") or 0) > 95
    assert "asymmetry of the rotor's resistance -29.0 dB" in " ".join(words(document, "#answer td"))


def test_a_recording_says_what_is_not_told_apart_and_what_would_tell(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    recording_id = recorded.add(SOUND_ROTOR, classification=turns_or_joint())
    told = " ".join(words(page(client.get(f"/recordings/{recording_id}")), "section"))
    assert "Not told apart: shorted turns or high-resistance connection." in told
    assert "What would tell: a record at another load" in told
