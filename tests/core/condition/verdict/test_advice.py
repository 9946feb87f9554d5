"""The advice: one for every state and kind, in words for who plans the work."""

from itertools import product

import pytest

from core.condition.kinds import BESIDE_STATOR, Kind, State
from core.condition.verdict.advice import advice

OF_STATOR = [kind for kind in Kind if kind not in BESIDE_STATOR]


@pytest.mark.parametrize(("state", "kind"), [*product(State, OF_STATOR)])
def test_every_state_and_kind_has_an_advice(state: State, kind: Kind) -> None:
    text = advice(state, kind, phase="b")
    sentences = text.split(". ")
    assert 1 <= len(sentences) <= 3
    assert all(sentence[0].isupper() for sentence in sentences)
    assert text.endswith(".")
    assert "{" not in text


def test_kinds_on_watch_ask_for_different_things() -> None:
    found = {advice(State.WATCH, kind) for kind in OF_STATOR}
    assert len(found) == len(OF_STATOR)


@pytest.mark.parametrize("one", [Kind.SHORTED_TURNS, Kind.ASYMMETRY])
@pytest.mark.parametrize("other", [Kind.CONNECTION, Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL])
def test_of_two_kinds_it_says_what_record_would_tell(one: Kind, other: Kind) -> None:
    either = advice(State.WATCH, Kind.UNCLEAR, candidates=(one, other))
    assert either == advice(State.WATCH, Kind.UNCLEAR, candidates=(other, one))
    assert either != advice(State.WATCH, Kind.UNCLEAR), "not that of a single record"
    assert either != advice(State.WATCH, Kind.UNCLEAR, candidates=(Kind.SUPPLY, Kind.ROTOR))
    assert "another load" in either or "other motors" in either


def test_a_single_record_that_differs_asks_for_another() -> None:
    assert "recorded again" in advice(State.WATCH, Kind.UNCLEAR)


def test_a_fault_is_more_urgent_than_a_watch_and_names_its_phase() -> None:
    fault = advice(State.FAULT, Kind.SHORTED_TURNS, phase="c")
    assert "phase c" in fault
    assert "next opportunity" in fault
    assert "next opportunity" not in advice(State.WATCH, Kind.SHORTED_TURNS, phase="c")
