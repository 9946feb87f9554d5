"""Daily and weekly summaries: made once, by whichever service is the first to see that one is due."""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from datetime import datetime, timedelta

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_SECOND
from service.condition.staleness import is_stale, stale_after_ns
from service.condition.wording import beside_stator
from service.configuration.notifications import Digest
from service.configuration.settings import Settings
from service.notifications.due import due_now
from service.senders.sending import recipients
from service.storage import Repository
from service.storage.records import MotorHealth, NewNotification
from service.storage.states import LinkState, NotificationKind

MOST_NAMED = 20
"""So many motors and relays are named; the others are counted."""

PERIODS = {"daily": timedelta(days=1), "weekly": timedelta(days=7)}
BAD_FIRST = (State.FAULT, State.WATCH)
WORST_FIRST = (*BAD_FIRST, *(state for state in State if state not in BAD_FIRST))


def due_digests(settings: Settings, repository: Repository, now_ns: int) -> Iterator[NewNotification]:
    """Yield the messages of the digests that are due and not made yet. Raises SQLAlchemyError."""
    wanted = settings.notifications
    for digest, due in due_now(wanted.digests, wanted.time_zone, repository, now_ns):
        missing = [
            (channel, recipient, key)
            for channel in digest.channels
            for recipient in recipients(wanted.channels[channel])
            if not repository.is_known_notification(key := _key(digest, due, channel, recipient))
        ]
        if missing:
            document = _document(settings, repository, digest, due)
            for channel, recipient, key in missing:
                yield NewNotification(NotificationKind.DIGEST, channel, recipient, document, key)


def _key(digest: Digest, due: datetime, channel: str, recipient: str) -> str:
    """Return what tells a digest from all others, whatever else changes in the settings."""
    sites = "" if digest.sites is None else ",".join(sorted(digest.sites))
    return f"{digest.period} digest {due:%Y-%m-%d %H:%M} {sites} {channel} {recipient}"


def _document(
    settings: Settings, repository: Repository, digest: Digest, due: datetime
) -> Mapping[str, object]:
    to_ns = round(due.timestamp()) * NANOSECONDS_PER_SECOND
    from_ns = round((due - PERIODS[digest.period]).timestamp()) * NANOSECONDS_PER_SECOND
    motors = list(_motors(repository, digest.sites))
    states_of = Counter(motor.condition.state for motor in motors)
    calls = repository.calls_of_alarms(from_ns=from_ns, to_ns=to_ns, sites=digest.sites)
    states = repository.open_alarm_states(sites=digest.sites)
    down = sorted({motor.ied.name for motor in motors if motor.ied.link_state is not LinkState.UP})
    stale = [motor.motor.name for motor in motors if _is_stale(motor, settings, to_ns)]
    return {
        "period": digest.period,
        "from_ns": from_ns,
        "to_ns": to_ns,
        "sites": None if digest.sites is None else list(digest.sites),
        "motors": {state.value: states_of[state] for state in WORST_FIRST if states_of[state]},
        "attention": [_facts(motor) for motor in _worst(motors)[:MOST_NAMED]],
        "alarms_raised": {kind.value: number for kind, number in calls.items()},
        "alarms_open": {state.value: number for state, number in states.items()},
        "links_not_up": {"number": len(down), "relays": down[:MOST_NAMED]},
        "stale": {"number": len(stale), "motors": stale[:MOST_NAMED]},
        "given_up": repository.given_up_notifications(from_ns=from_ns, to_ns=to_ns),
    }


def _motors(repository: Repository, sites: Collection[str] | None) -> Iterator[MotorHealth]:
    after = None
    while True:
        page = repository.health_of_motors(limit=500, after=after)
        yield from (motor for motor in page.items if sites is None or motor.motor.site in sites)
        after = page.next
        if after is None:
            return


def _worst(motors: Collection[MotorHealth]) -> list[MotorHealth]:
    """Return the motors that need attention, the worst first."""
    found = [motor for motor in motors if motor.condition.state in BAD_FIRST]
    return sorted(
        found,
        key=lambda motor: (BAD_FIRST.index(motor.condition.state), -(motor.condition.mu_f or 0.0)),
    )


def _is_stale(motor: MotorHealth, settings: Settings, now_ns: int) -> bool:
    oldest_ns = stale_after_ns(motor.motor.schedule, settings.stale_after_days)
    return is_stale(motor.condition, now_ns, oldest_ns)


def _facts(motor: MotorHealth) -> Mapping[str, object]:
    condition = motor.condition
    likely = condition.phase_probabilities
    return {
        "motor": motor.motor.name,
        "site": motor.motor.site,
        "state": condition.state.value,
        "kind": condition.kind.value,
        "finding": beside_stator(condition),
        "phase": condition.phase,
        "phase_probabilities": None if likely is None else list(likely),
        "mu_f": condition.mu_f,
        "mu_f_ci95": None if condition.mu_f_ci95 is None else list(condition.mu_f_ci95),
        "since_ns": condition.since_ns,
        "advice": (condition.document or {}).get("advice"),
    }
