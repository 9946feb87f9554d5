"""What the fleet shows of each motor."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b

from core.condition.kinds import State
from core.diagnosis.verdict import Verdict
from core.machines.parameters import ParametersSource
from service.api.conditions.documents import condition_document
from service.api.conditions.schemas import Condition
from service.condition.staleness import Missing, missing, stale_after_ns
from service.condition.wording import advice_now, cause, expected
from service.storage.records import CallingAlarms, FleetMotor
from service.storage.states import LinkState
from service.web.fleet.states import RANKS, FleetState, states_of
from service.web.words import day, percent

Interval = tuple[float, float]

COARSE = 0.05
"""Where only larger changes would be seen, that a motor is healthy says little of its windings."""

SENTENCES_OF_ADVICE = 2
"""What to check, and how urgent it is. The motor's page has the rest."""


@dataclass(frozen=True)
class FleetRow:
    """A motor.

    states: the one that matters most first.  judged: what its records told last.  kind: what has changed, in
    words with the phase; empty where nothing has.  level, interval: fault level in all.
    visible: least step of the level that would be seen; is_of_record: within the latest record alone, because
    the reference is not complete.  since_ns: first record that shows it; is_from_first_record: it was there
    before.  growth_per_day, days: None where there is no trend; days: to the level `limit`, counted from the
    latest record.  reference: levels between which no change would be seen.  advice: empty where nothing is
    to be done.  doubt: why a healthy motor may not be; empty where nothing speaks against it.
    not_assessed: parts that no record could judge.  version: of its condition.
    """

    name: str
    description: str
    site: str
    ied: str
    link: LinkState
    states: tuple[FleetState, ...]
    judged: State
    kind: str
    level: float | None
    interval: Interval | None
    visible: float | None
    is_of_record: bool
    load: float | None
    since_ns: int | None
    is_from_first_record: bool
    growth_per_day: float | None
    days: tuple[float, float, float] | None
    limit: float | None
    as_of_ns: int | None
    stood_ns: int | None
    advice: str
    doubt: str
    not_assessed: tuple[str, ...]
    alarms: CallingAlarms | None
    reference: Interval | None
    version: int

    @property
    def state(self) -> FleetState:
        """Return the state that matters most."""
        return self.states[0]

    @property
    def is_at_rest(self) -> bool:
        """Tell whether the motor was seen to stand after its latest record."""
        return self.stood_ns is not None and (self.as_of_ns is None or self.stood_ns > self.as_of_ns)

    @property
    def key(self) -> str:
        """Return what the row is called within the page, whatever is in the motor's name."""
        return f"motor-{digest(self.name)}"

    @cached_property
    def digest(self) -> str:
        """Return another text when anything else is told of the motor, but for ages."""
        return digest(self)

    def expected(self, now_ns: int) -> str:
        """Return when the level ahead is reached; empty without a trend."""
        if self.days is None or self.limit is None or self.as_of_ns is None:
            return ""
        return expected(percent(self.limit), self.as_of_ns, self.days, now_ns, day, short=True)

    @property
    def needs_attention(self) -> bool:
        """Tell whether somebody has to look after the motor."""
        return self.alarms is not None or self.state in (FleetState.FAULT, FleetState.WATCH)

    @property
    def attention(self) -> tuple[int, int, bool, float, int, str]:
        """Return the key by which motors are sorted, those that need attention first.

        Alarms that nobody has acknowledged, then severity and doubts, then growth, then the age of the data.
        """
        urgency = -1 if self.alarms is None else self.alarms.urgency
        growth = self.growth_per_day or 0.0
        return (-urgency, RANKS[self.state], not self.doubt, -growth, self.as_of_ns or 0, self.name)


def digest(*told: object) -> str:
    """Return a short text that is another one where anything else is told."""
    return blake2b(repr(told).encode("utf-8", "backslashreplace"), digest_size=6).hexdigest()


def row_of(motor: FleetMotor, now_ns: int, stale_after_days: float | None) -> FleetRow:
    """Return what the fleet shows of a motor now. stale_after_days: what the settings say of all motors."""
    entry, figures = motor.condition, motor.figures
    oldest_ns = stale_after_ns(motor.motor.schedule, stale_after_days)
    condition = condition_document(entry, now_ns, oldest_ns, source=motor.motor.parameters_source)
    states = states_of(entry, now_ns, oldest_ns)
    why = missing(entry.as_of_ns, entry.stood_ns, now_ns, oldest_ns)
    detectable = condition.reference.detectable
    limit = None if figures is None else figures.detection_limit
    return FleetRow(
        name=motor.motor.name,
        description=motor.motor.description,
        site=motor.motor.site,
        ied=motor.motor.ied,
        link=motor.link,
        states=states,
        judged=entry.state,
        kind=cause(condition),
        level=condition.mu_f,
        interval=condition.mu_f_ci95,
        visible=limit if detectable is None else detectable,
        is_of_record=detectable is None,
        load=None if figures is None else figures.load_level,
        since_ns=entry.since_ns,
        is_from_first_record=condition.since is not None and condition.since == condition.reference.since,
        growth_per_day=condition.growth_per_day,
        days=condition.forecast.days,
        limit=condition.forecast.limit,
        as_of_ns=entry.as_of_ns,
        stood_ns=entry.stood_ns,
        advice=_advice(condition, states[0], why, motor.motor.parameters_source),
        doubt=doubt(condition, None if figures is None else figures.verdict),
        not_assessed=tuple(one.part.words for one in condition.parts if one.state is State.UNKNOWN),
        alarms=motor.alarms,
        reference=_reference(condition),
        version=entry.version,
    )


def _advice(condition: Condition, state: FleetState, why: Missing | None, source: ParametersSource) -> str:
    """Return what to do first, in a sentence or two; nothing where nothing has to be done."""
    if state is FleetState.HEALTHY and source is not ParametersSource.TYPICAL:
        return ""
    sentences = advice_now(condition.advice, condition.state, why).split(". ")
    told = ". ".join(sentences[:SENTENCES_OF_ADVICE])
    return told if told.endswith(".") else f"{told}."


def doubt(condition: Condition, latest: Verdict | None) -> str:
    """Return why a motor that counts as healthy may not be; empty where nothing speaks against it.

    latest: what its latest record says by itself.
    """
    detectable = condition.reference.detectable
    if condition.state is not State.HEALTHY or detectable is None or detectable <= COARSE:
        return ""
    beside = ", and its latest record by itself shows a fault" if latest is Verdict.FAULT else ""
    return f"Its reference is uneven: a change below {percent(detectable, 0)} would not be seen{beside}."


def _reference(condition: Condition) -> Interval | None:
    """Return the levels that cannot be told from what the motor was like before any change.

    They lie around the level then, as far as a change that would be seen, or as the interval of the change
    that is seen. None before the reference is complete.
    """
    if condition.mu_f is None or not condition.reference.complete:
        return None
    reach = condition.reference.detectable
    if reach is None and condition.change_ci95 is not None:
        reach = (condition.change_ci95[1] - condition.change_ci95[0]) / 2.0
    if reach is None:
        return None
    base = condition.mu_f - max(condition.change or 0.0, 0.0)
    return (max(base - reach, 0.0), base + reach)


def counts(rows: Iterable[FleetRow]) -> Mapping[FleetState, int]:
    """Return how many motors are in each state; each counts once, in the one that matters most."""
    number = Counter(row.state for row in rows)
    return {state: number[state] for state in FleetState}


def parts_not_assessed(rows: Iterable[FleetRow]) -> Mapping[str, int]:
    """Return of how many motors each part is not assessed, the most first; parts of none are left out."""
    return dict(Counter(part for row in rows for part in row.not_assessed).most_common())
