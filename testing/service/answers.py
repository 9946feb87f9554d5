"""Answers of records, for tests without a worker."""

from core.classification.classification import Classification, classify
from core.classification.evidence import Block, Evidence, only
from core.diagnosis.causes import Cause


def answer_of(**nats: float) -> Classification:
    """The answer of evidence for single causes, named as in `Cause` in lower case: pulsation=20.0."""
    blocks = [only(Cause[name.upper()], ratio, f"figure of {name}") for name, ratio in nats.items()]
    return classify(Evidence(tuple(blocks)))


def turns_or_joint() -> Classification:
    """The answer of a record that does not tell shorted turns from a joint."""
    turns, joint = frozenset({Cause.SHORTED_TURNS}), frozenset({Cause.CONNECTION})
    ratios = {turns: 20.0, joint: 19.5, turns | joint: 20.0}
    return classify(Evidence((Block(turns | joint, ratios, {Cause.SHORTED_TURNS: "phase b"}),)))
