"""Reads from the database what gateways tell."""

from collections.abc import Callable, Iterator
from typing import Final

from core.condition.kinds import State
from core.condition.verdict.advice import advice
from core.condition.verdict.phase_words import turns_phases
from core.motor_condition.parts import Part
from core.rotor.finding import RotorState
from core.units import NANOSECONDS_PER_DAY
from service.condition.staleness import is_stale, stale_after_ns
from service.condition.wording import cause
from service.gateways.plant_state.device_health import health_of_motor, health_of_relay
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality, RelayFigures
from service.gateways.plant_state.running_state import RunningState, running_state
from service.storage.records import Cursor, FleetMotor, IedEntry, Page, UnbalanceEntry
from service.storage.repository import Repository

PAGE = 500
MOST_ALARMS = 1_000_000
"""More than are ever open (a relay raises a thousand of a kind): one left out would be told as over."""

MOST_REASONS = 10
AHEAD_NS = NANOSECONDS_PER_DAY
"""A record may be so far ahead of the service's clock: relays may keep local time."""
NOT_JUDGED = "no valid record of the motor has been judged yet"


def read_plant_state(repository: Repository, *, now_ns: int, stale_after_days: float | None) -> PlantState:
    """Return what is to be told now. stale_after_days: that of the settings.

    Raises SQLAlchemyError where the database does not answer.
    """
    unbalances = {one.motor: one for one in repository.latest_unbalances()}
    motors = [
        _motor(one, unbalances.get(one.motor.name), now_ns, stale_after_days) for one in repository.fleet()
    ]
    relays = [_relay(one) for one in _all(lambda after: repository.relays(limit=PAGE, after=after))]
    alarms = repository.open_alarms(limit=MOST_ALARMS).items
    return PlantState(
        motors={motor.name: motor for motor in motors},
        relays={relay.name: relay for relay in relays},
        alarms={alarm.id: alarm for alarm in alarms},
        read_ns=now_ns,
    )


def _all(page_after: Callable[[Cursor | None], Page[IedEntry]]) -> Iterator[IedEntry]:
    page = page_after(None)
    yield from page.items
    while page.next is not None:
        page = page_after(page.next)
        yield from page.items


def _motor(
    one: FleetMotor, unbalance: UnbalanceEntry | None, now_ns: int, stale_after_days: float | None
) -> MotorFigures:
    condition = one.condition
    oldest_ns = stale_after_ns(one.motor.schedule, stale_after_days)
    stale = is_stale(condition, now_ns, oldest_ns)
    rotor = _ROTORS.get(condition.state_of(Part.ROTOR))
    quality, reason = _quality(one, now_ns, stale=stale)
    running = running_state(one.link, condition.as_of_ns, condition.stood_ns)
    seen_ns = max(condition.as_of_ns or 0, condition.stood_ns or 0)
    is_seen_lately = running is RunningState.UNKNOWN or now_ns - seen_ns <= oldest_ns
    return MotorFigures(
        name=one.motor.name,
        description=one.motor.description,
        site=one.motor.site,
        relay=one.motor.ied,
        state=condition.state,
        kind=condition.kind,
        finding=cause(condition),
        phase=condition.phase,
        phase_probabilities=turns_phases(
            (condition.kind, *condition.candidates), condition.phase_probabilities
        ),
        mu_f=condition.mu_f,
        mu_f_ci95=condition.mu_f_ci95,
        change=condition.change,
        change_ci95=condition.change_ci95,
        detection_limit=None if one.figures is None else one.figures.detection_limit,
        load_level=None if one.figures is None else one.figures.load_level,
        rotor=rotor,
        device_health=health_of_motor(condition.state, condition.kind, stale=stale),
        since_ns=condition.since_ns,
        as_of_ns=condition.as_of_ns,
        stale=stale,
        advice=_advice(one),
        reasons=_reasons(one),
        alarms=0 if one.alarms is None else one.alarms.number,
        priority=None if one.alarms is None else one.alarms.priority,
        quality=quality,
        quality_reason=reason,
        voltage_unbalance=None if unbalance is None else unbalance.voltage_unbalance_iec,
        current_unbalance=None if unbalance is None else unbalance.current_unbalance,
        unbalance_ns=None if unbalance is None else unbalance.time_ns,
        running=running,
        running_ns=one.link_changed_ns if running is RunningState.UNKNOWN else seen_ns,
        running_quality=Quality.GOOD if is_seen_lately else Quality.UNCERTAIN,
    )


_ROTORS: Final = {State.WATCH: RotorState.WATCH, State.FAULT: RotorState.FAULT}


def _quality(one: FleetMotor, now_ns: int, *, stale: bool) -> tuple[Quality, str | None]:
    """Return how far the figures of a motor can be relied on, and why not further."""
    condition = one.condition
    if condition.as_of_ns is None:
        return Quality.BAD, NOT_JUDGED
    if condition.problem is not None:
        return Quality.UNCERTAIN, f"later records are not taken into account: {condition.problem}"
    if condition.as_of_ns > now_ns + AHEAD_NS:
        return Quality.UNCERTAIN, "the latest record is of a later time than now: a clock is wrong"
    if stale:
        return Quality.UNCERTAIN, "the latest record that counts is older than the next ones were due"
    if condition.state is State.UNKNOWN:
        return Quality.UNCERTAIN, "the records do not tell the condition"
    return Quality.GOOD, None


def _advice(one: FleetMotor) -> str:
    document = one.condition.document or {}
    told = document.get("advice")
    return told if isinstance(told, str) else advice(one.condition.state, one.condition.kind)


def _reasons(one: FleetMotor) -> tuple[str, ...]:
    document = one.condition.document or {}
    told = document.get("reasons")
    if not isinstance(told, list):
        return (NOT_JUDGED,)
    return tuple(str(reason) for reason in told[:MOST_REASONS])


def _relay(entry: IedEntry) -> RelayFigures:
    return RelayFigures(
        name=entry.name,
        site=entry.site,
        manufacturer=entry.manufacturer,
        type=entry.type,
        link=entry.link_state,
        link_reason=entry.link_reason,
        changed_ns=entry.link_changed_ns,
        device_health=health_of_relay(entry.link_state),
        quality=Quality.GOOD,
        quality_reason=None,
    )
