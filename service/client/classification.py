"""The one answer of a record, or of a motor, as text for people."""

from collections.abc import Iterator
from typing import Final

from core.classification.causes import words
from core.classification.classification import Classification

LEAST_SHOWN: Final = 0.02
"""Causes with less probability than this are left out."""


def answer_rows(answer: Classification) -> Iterator[tuple[str, str]]:
    """Yield the rows of a table: the answer, how likely each cause is, why, and what would tell."""
    yield "answer", f"{answer.words} ({answer.answer.probability:.0%})"
    for one in answer.likelihoods:
        if one.log_likelihood_ratio is not None and one.probability >= LEAST_SHOWN:
            yield "likelihood", f"{words(frozenset({one.cause}))} {one.probability:.0%}: {one.figure}"
    for reason in answer.reasons:
        yield "answer because", reason
    for pair in answer.not_told_apart:
        both = f"{words(pair.one.causes)} or {words(pair.other.causes)}"
        yield "would tell", f"{both}: {'; '.join(pair.tests)}"
