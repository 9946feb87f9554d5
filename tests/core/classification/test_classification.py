"""Explanations weighed by evidence that is given, without a record."""

from itertools import combinations
from math import log

import pytest

from core.classification.classification import classify
from core.classification.evidence import MOST_NATS, Block, Evidence, Verdict
from core.classification.telling import what_tells
from core.diagnosis.causes import PRIORS, Cause

TURNS, JOINT, CAGE = Cause.SHORTED_TURNS, Cause.CONNECTION, Cause.ROTOR


def _alone(cause: Cause, nats: float) -> Block:
    return Block(frozenset({cause}), {frozenset({cause}): nats}, {cause: "a figure"})


def _either(turns: float, joint: float, both: float) -> Block:
    ratios = {frozenset({TURNS}): turns, frozenset({JOINT}): joint, frozenset({TURNS, JOINT}): both}
    return Block(frozenset({TURNS, JOINT}), ratios)


def test_the_probability_of_one_cause_is_that_of_bayes() -> None:
    found = classify(Evidence((_alone(TURNS, log(50.0)),)))
    odds = 50.0 * PRIORS[TURNS] / (1.0 - PRIORS[TURNS])
    likelihood = next(one for one in found.likelihoods if one.cause is TURNS)
    assert likelihood.probability == pytest.approx(odds / (1.0 + odds))
    assert likelihood.log_likelihood_ratio == pytest.approx(log(50.0))


def test_causes_of_different_figures_are_found_together() -> None:
    found = classify(Evidence((_alone(TURNS, 20.0), _alone(CAGE, 15.0))))
    assert found.is_told
    assert found.answer.causes == {TURNS, CAGE}
    assert found.words == "shorted turns with uneven rotor"


def test_two_causes_with_like_figures_are_not_told_apart_and_what_would_tell_is_said() -> None:
    found = classify(Evidence((_either(20.0, 19.5, 20.2),)))
    assert not found.is_told
    assert found.words == "not told apart: shorted turns or high-resistance connection"
    (pair,) = found.not_told_apart
    assert {pair.one.causes, pair.other.causes} == {frozenset({TURNS}), frozenset({JOINT})}
    assert any("another load" in test for test in pair.tests)


def test_no_block_is_more_certain_than_models_are() -> None:
    block = _either(10.0 * MOST_NATS, 10.0 * MOST_NATS - 3.0, 10.0 * MOST_NATS)
    assert block.of(frozenset({TURNS})) == pytest.approx(MOST_NATS)
    assert block.of(frozenset({JOINT})) == pytest.approx(MOST_NATS - 3.0), "as much less likely as before"
    far = _either(10.0 * MOST_NATS, 2.0 * MOST_NATS, 10.0 * MOST_NATS)
    assert far.of(frozenset({JOINT})) == 0.0
    assert block.of(frozenset({CAGE})) == 0.0


def test_a_motor_of_whose_winding_nothing_is_known_is_not_called_healthy() -> None:
    found = classify(Evidence((_alone(CAGE, -3.0),), {TURNS: "no voltages"}))
    assert not found.is_told
    assert found.words == "nothing is seen, and not all is known"
    document = found.as_dict()
    assert (document["answer"], document["probability"]) == ([], 0.0)
    assert not classify(Evidence(())).is_told


def test_without_evidence_there_is_no_answer() -> None:
    document = classify(Evidence((), {TURNS: "the quality gate refused the record"})).as_dict()
    assert (document["answer"], document["probability"], document["is_told"]) == ([], 0.0, False)
    assert (document["words"], document["explanations"]) == ("not assessed", [])
    assert isinstance(document["likelihoods"], list)
    assert [one["cause"] for one in document["likelihoods"]] == [str(TURNS)]


def test_what_nothing_is_known_of_keeps_its_prior_and_is_named() -> None:
    found = classify(Evidence((_alone(TURNS, -3.0),), {CAGE: "too short"}))
    assert found.words == "healthy"
    untold = next(one for one in found.likelihoods if one.cause is CAGE)
    assert untold.log_likelihood_ratio is None
    assert untold.probability == PRIORS[CAGE]
    assert "nothing is known of: uneven rotor" in found.reasons


def test_an_answer_that_differs_from_a_verdict_says_so() -> None:
    fault = Verdict(TURNS, is_there=True, words="fault, shorted turns in phase b")
    differs = classify(Evidence((_alone(TURNS, -3.0),), {}, (fault,)))
    agrees = classify(Evidence((_alone(TURNS, 20.0),), {}, (fault,)))
    assert any("the verdict differs: fault, shorted turns in phase b" in one for one in differs.reasons)
    assert not any("differs" in one for one in agrees.reasons)


def test_every_pair_of_explanations_has_a_test_that_tells() -> None:
    singles = [frozenset({cause}) for cause in PRIORS]
    for one, other in combinations([frozenset[Cause](), *singles], 2):
        assert what_tells(one, other), (one, other)
