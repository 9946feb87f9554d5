"""The one answer of a record, or of a motor, as text for people, the same in commands and on pages."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from core.diagnosis.causes import IN_WORDS
from core.terms import phrase

LEAST_SHOWN: Final = 0.02
"""Causes with less probability than this are left out."""
WORDS: Final = {str(cause): words for cause, words in IN_WORDS.items()}


@dataclass(frozen=True, slots=True)
class CauseShown:
    """One cause: its name in words, its probability in percent, and what was measured of it."""

    words: str
    percent: int
    figure: str


@dataclass(frozen=True, slots=True)
class OpenShown:
    """What is not told apart, in words, and what would tell."""

    words: str
    tests: Sequence[str]


@dataclass(frozen=True, slots=True)
class AnswerShown:
    """An answer as people read it. causes: the likeliest first."""

    words: str
    percent: int
    is_told: bool
    is_sound: bool
    causes: Sequence[CauseShown]
    open_ones: Sequence[OpenShown]
    reasons: Sequence[str]


def answer_shown(document: Mapping[str, Any]) -> AnswerShown:
    """Return what people read of an answer's document (`Classification.as_dict`)."""
    likely = [
        one
        for one in document["likelihoods"]
        if one["log_likelihood_ratio"] is not None and one["probability"] >= LEAST_SHOWN
    ]
    return AnswerShown(
        words=str(document["words"]),
        percent=round(100.0 * document["probability"]),
        is_told=bool(document["is_told"]),
        is_sound=document["answer"] == ["healthy"],
        causes=tuple(
            CauseShown(_words([one["cause"]]), round(100.0 * one["probability"]), str(one["figure"]))
            for one in likely
        ),
        open_ones=tuple(
            OpenShown(" or ".join(map(_words, one["explanations"])), one["tests"])
            for one in document["not_told_apart"]
        ),
        reasons=document["reasons"],
    )


def answer_rows(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the rows of a table: the answer, how likely each cause is, why, and what would tell."""
    shown = answer_shown(document)
    yield "answer", f"{shown.words} ({shown.percent} %)" if document["answer"] else shown.words
    for one in shown.causes:
        yield "likelihood", f"{one.words} {one.percent} %" + (f": {one.figure}" if one.figure else "")
    for reason in shown.reasons:
        yield "answer because", reason
    for pair in shown.open_ones:
        yield "would tell", f"{pair.words}: {'; '.join(pair.tests)}"


def _words(names: Sequence[str]) -> str:
    return " with ".join(WORDS.get(name, phrase(name)) for name in names)
