"""The confusion matrix of single records, with its picture, and what is found of pairs of causes."""

from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path
from statistics import median

from benchmarks.classification.cases import MOTORS, ONE_RECORD, PAIRS, Result, Subject, answered
from benchmarks.classification.outcomes import Outcome
from benchmarks.classification.picture import Answer, draw_matrix, in_words
from benchmarks.reporting import Section, rate_text, spread, table
from core.diagnosis.causes import IN_WORDS, NOTHING, Cause, Causes

PICTURE = Path("docs/evidence/images/classification/confusion.svg")
LOADS, PAIR_LOADS = (0.25, 0.5, 0.75, 1.0), (0.5, 0.9)
FIRST_SEED, PAIR_SEED, HEALTHY_SEED = 5_000, 6_000, 7_000
HEALTHY_EACH, SINGLE_EACH = 10, 2
TRUTHS: tuple[Causes, ...] = (NOTHING, *(frozenset({cause}) for cause in ONE_RECORD))


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The matrix of single causes, and the table of pairs."""
    healthy_each, single_each = (1, 1) if quick else (HEALTHY_EACH, SINGLE_EACH)
    loads = LOADS[1::2] if quick else LOADS
    healthy = [
        Subject(motor, load, NOTHING, HEALTHY_SEED + _number(motor, load, k))
        for motor in MOTORS
        for load in loads
        for k in range(healthy_each)
    ]
    singles = [
        Subject(motor, load, frozenset({cause}), FIRST_SEED + _number(motor, load, k))
        for cause in ONE_RECORD
        for motor in MOTORS
        for load in loads
        for k in range(single_each)
    ]
    pairs = [
        Subject(motor, load, two, PAIR_SEED + _number(motor, load, k))
        for k, two in enumerate(PAIRS[:: 6 if quick else 1])
        for motor in MOTORS
        for load in PAIR_LOADS
    ]
    single_results = list(spread(answered, [*healthy, *singles], "single causes", pool))
    pair_results = list(spread(answered, pairs, "pairs", pool))
    if not quick:
        answers = [Answer(one.subject.causes, one.likeliest, one.told) for one in single_results]
        draw_matrix(PICTURE, TRUTHS, answers)
    return [_single(single_results), _pairs(pair_results)]


def _number(motor: str, load: float, k: int) -> int:
    return 1_000 * list(MOTORS).index(motor) + round(100 * load) + 101 * k


def _single(results: Sequence[Result]) -> Section:
    rows = []
    for causes in TRUTHS:
        own = [one for one in results if one.subject.causes == causes]
        counts = Counter(one.outcome for one in own)
        rows.append([in_words(causes), str(len(own)), *(str(counts[outcome]) for outcome in Outcome)])
    healthy = [one for one in results if not one.subject.causes]
    false = sum(one.told and bool(one.likeliest) for one in healthy)
    left_open = sum(one.outcome is Outcome.AMONG for one in healthy)
    with_cause = [one for one in results if one.subject.causes]
    times_ms = [1e3 * one.seconds for one in results]
    lines = [
        "Records of 5 s at 4 kHz, loads of 25 to 100 %, one cause at a time or none.",
        "",
        *table(["truth", "records", *map(str, Outcome)], rows),
        "",
        f"- Healthy motors that are told a cause: {rate_text(false, len(healthy))}; left open: "
        f"{rate_text(left_open, len(healthy))}.",
        *_figures(with_cause),
        f"- The answer takes {median(times_ms):.0f} ms beside the examination of its record (median; "
        f"{max(times_ms):.0f} ms at most).",
        "",
        f"![Confusion matrix](images/classification/{PICTURE.name})",
        "",
        "Rows are the truth, columns the likeliest explanation where it is told, in percent of the row.",
    ]
    command = "python -m benchmarks.classification --subject confusion"
    return Section("single", "One cause", command, tuple(lines))


def _pairs(results: Sequence[Result]) -> Section:
    rows = []
    for cause in ONE_RECORD:
        own = [one for one in results if cause in one.subject.causes]
        counts = Counter(one.outcome for one in own)
        named = sum(cause in one.likeliest for one in own)
        rows.append(
            [
                IN_WORDS[cause],
                str(len(own)),
                f"{named}",
                *(str(counts[outcome]) for outcome in Outcome),
            ]
        )
    lines = [
        f"{len({one.subject.causes for one in results})} pairs of causes at 50 and 90 % load of the three "
        "motors. A row counts the records in which its cause is one of the two; named: in the likeliest "
        "explanation, told or not.",
        "",
        *table(["one of the two", "records", "named", *map(str, Outcome)], rows),
        "",
        *_figures(results),
        "",
        *_what_hides(results),
    ]
    command = "python -m benchmarks.classification --subject confusion"
    return Section("pairs", "Two causes", command, tuple(lines))


def _what_hides(results: Sequence[Result]) -> list[str]:
    """Say what the table does not show at first sight."""
    partly = sum(one.outcome is Outcome.PARTLY for one in results)
    beside = [one for one in results if Cause.CURRENT_CHANNEL in one.subject.causes]
    right = sum(one.outcome is Outcome.RIGHT for one in beside)
    return [
        f"In {partly / len(results):.0%} of these records one of the two causes is named without the other, "
        "told as if it were alone or left open beside other single ones: what the stronger cause leaves "
        "unexplained is larger than what the weaker one does. So a wrong current channel beside anything "
        f"else is right in {right} of {len(beside)}. Pairs are tried in single records alone, not over a "
        "motor's life.",
    ]


def _figures(results: Sequence[Result]) -> list[str]:
    count = len(results)
    return [
        f"- {outcome}: {rate_text(sum(one.outcome is outcome for one in results), count)}."
        for outcome in Outcome
    ]
