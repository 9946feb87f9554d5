"""The confusion matrix of motors: a healthy past, then a cause, and what is said from record to record."""

from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from typing import NamedTuple

from benchmarks.classification.cases import MOTORS
from benchmarks.classification.following import FollowedMotor
from benchmarks.classification.lives import PAST, PRESENT, STARTS_OF_PAST, STARTS_OF_PRESENT, Life
from benchmarks.classification.outcomes import Outcome, outcome_of
from benchmarks.classification.picture import Answer, draw_matrix, in_words
from benchmarks.reporting import Section, rate_text, spread, table
from core.diagnosis.causes import NOTHING, PRIORS, Causes
from core.recordings import Recording

PICTURE = Path("docs/evidence/images/classification/motors.svg")
FIRST_SEED, SEEDS = 8_500, 2
TRUTHS: tuple[Causes, ...] = (NOTHING, *(frozenset({cause}) for cause in PRIORS))


class Said(NamedTuple):
    """The answer after one record."""

    outcome: Outcome
    likeliest: Causes
    told: bool


@dataclass(frozen=True, slots=True)
class Course:
    """What was said of one motor while a cause was there, record by record."""

    truth: Causes
    said: tuple[Said, ...]

    @property
    def right_after(self) -> int | None:
        """Records after which the answer was right and stayed so; None where it was not at the end."""
        for record in range(len(self.said), 0, -1):
            if self.said[record - 1].outcome is not Outcome.RIGHT:
                return record + 1 if record < len(self.said) else None
        return 1


@dataclass(frozen=True, slots=True)
class Result:
    """What was said of one motor in its healthy past, and with each cause from then on."""

    past: tuple[Said, ...]
    courses: tuple[Course, ...]


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The matrix of motors."""
    truths = TRUTHS[::4] if quick else TRUTHS
    lives = [
        Life(motor, FIRST_SEED + 100 * list(MOTORS).index(motor) + k)
        for k in range(1 if quick else SEEDS)
        for motor in MOTORS
    ]
    results = list(spread(partial(lived, truths), lives, "motors", pool))
    courses = [one for result in results for one in result.courses]
    if not quick:
        ends = [Answer(one.truth, one.said[-1].likeliest, one.said[-1].told) for one in courses]
        draw_matrix(PICTURE, TRUTHS, ends)
    return [_section(results, courses, truths)]


def lived(truths: Sequence[Causes], life: Life) -> Result:
    """Follow a motor through its past, and from there on with each of the causes."""
    motor = FollowedMotor(life.known())
    past = _followed(motor, life.past(), NOTHING)
    courses = [Course(truth, _followed(motor.copy(), life.present(truth), truth)) for truth in truths]
    return Result(past, tuple(courses))


def _followed(
    motor: FollowedMotor, recordings: Iterable[tuple[bool, Recording]], truth: Causes
) -> tuple[Said, ...]:
    said = []
    for is_start, recording in recordings:
        if is_start:
            motor.take_start(recording)
        else:
            motor.take_record(recording)
            answer = motor.answer()
            said.append(Said(outcome_of(answer, truth), answer.answer.causes, answer.is_told))
    return tuple(said)


def _section(results: Sequence[Result], courses: Sequence[Course], truths: Sequence[Causes]) -> Section:
    past = [said for result in results for said in result.past]
    false = sum(one.told and bool(one.likeliest) for one in past)
    left_open = sum(not one.told for one in past)
    ends = Counter(one.said[-1].outcome for one in courses if one.truth)
    faulty = sum(ends.values())
    lines = [
        f"{len(results)} motors with a past of {PAST} healthy records and {len(STARTS_OF_PAST)} starts, the "
        f"same for each row, then {PRESENT} records and {len(STARTS_OF_PRESENT)} starts with one cause. "
        "Records of 4 s at 4 kHz, one an hour. The usual load is 50 to 65 % of the rated torque and scatters "
        "by 5 %; voltage, unbalance and warmth vary; a load that changes does so by 25 to 40 % of the rated "
        "torque, either way; wrong parameters are those of a motor that was exchanged. Condition, rotor, "
        "starts, followed parameters and latest records are joined as the service joins them. Counted is the "
        "answer at the end.",
        "",
        *table(
            [
                "what begins",
                "motors",
                *map(str, Outcome),
                "records until right for good, median (most)",
                "answers that are wrong on the way",
            ],
            [_row(truth, [one for one in courses if one.truth == truth]) for truth in truths],
        ),
        "",
        f"- Answers in the healthy past that tell a cause: {rate_text(false, len(past))}; that leave it "
        f"open: {rate_text(left_open, len(past))}.",
        *(f"- {outcome}, of motors with a cause: {rate_text(ends[outcome], faulty)}." for outcome in Outcome),
        "",
        f"![Confusion matrix of motors](images/classification/{PICTURE.name})",
        "",
        "Rows are the truth, columns the answer at the end, in percent of the row.",
    ]
    command = "python -m benchmarks.classification --subject motors"
    return Section("motors", "A cause that begins", command, tuple(lines))


def _row(truth: Causes, courses: Sequence[Course]) -> list[str]:
    ends = Counter(one.said[-1].outcome for one in courses)
    after = [one.right_after for one in courses if one.right_after is not None]
    said = [said for one in courses for said in one.said]
    wrong = sum(one.outcome is Outcome.WRONG for one in said)
    return [
        in_words(truth),
        str(len(courses)),
        *(str(ends[outcome]) for outcome in Outcome),
        f"{median(after):g} ({max(after)})" if after else "-",
        f"{wrong} of {len(said)}",
    ]
