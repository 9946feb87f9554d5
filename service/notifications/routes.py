"""Who is told of what happened to an alarm: the routes of the settings."""

from collections.abc import Iterator, Mapping, Sequence

from core.units import NANOSECONDS_PER_SECOND
from service.alarms.kinds import AlarmKind
from service.configuration.channels import Channel
from service.configuration.notifications import NotificationSettings, Route
from service.notifications.hours import is_within, local, next_begin
from service.senders.sending import recipients
from service.storage.records import NotificationTarget, Occurrence
from service.storage.states import NotifiedEvent

CALLS = (NotifiedEvent.RAISED, NotifiedEvent.REOPENED)
"""Somebody has to act on these. What is over, or known to somebody, is not told later, and to nobody else."""

NANOSECONDS_PER_MINUTE = 60 * NANOSECONDS_PER_SECOND


def targets(
    settings: NotificationSettings, occurrence: Occurrence, now_ns: int
) -> Sequence[NotificationTarget]:
    """Return who is told, and when: each receiver once at a time, however many routes name it."""
    found: dict[tuple[str, str, int], NotificationTarget] = {}
    for route in settings.routes:
        for target in _of_route(settings, route, occurrence, now_ns):
            receiver = (target.channel, target.recipient, target.after_ns)
            known = found.get(receiver)
            if known is None or _begin(target) < _begin(known):
                found[receiver] = target
    return list(found.values())


def _of_route(
    settings: NotificationSettings, route: Route, occurrence: Occurrence, now_ns: int
) -> Iterator[NotificationTarget]:
    if not _fits(route, occurrence):
        return
    at = local(now_ns, settings.time_zone)
    held_until_ns = None
    if not is_within(route, at):
        if route.outside_hours == "skip" or occurrence.event not in CALLS:
            return
        held_until_ns = next_begin(route, at)
    yield from _to(settings.channels, route.channels, 0, held_until_ns)
    if occurrence.event in CALLS:
        for escalation in route.escalations:
            after_ns = round(escalation.after_min * NANOSECONDS_PER_MINUTE)
            yield from _to(settings.channels, escalation.channels, after_ns, held_until_ns)


def _to(
    channels: Mapping[str, Channel], names: Sequence[str], after_ns: int, held_until_ns: int | None
) -> Iterator[NotificationTarget]:
    for name in names:
        for recipient in recipients(channels[name]):
            yield NotificationTarget(name, recipient, after_ns, held_until_ns)


def _fits(route: Route, occurrence: Occurrence) -> bool:
    return (
        occurrence.event.value in route.events
        and (route.sites is None or occurrence.site in route.sites or _is_of_all_sites(occurrence))
        and (route.priorities is None or occurrence.priority.value in route.priorities)
        and (route.kinds is None or occurrence.kind in route.kinds)
    )


def _is_of_all_sites(occurrence: Occurrence) -> bool:
    """Tell whether an alarm tells those of several sites in one line."""
    return occurrence.site is None and occurrence.kind == AlarmKind.ALARM_FLOOD


def _begin(target: NotificationTarget) -> int:
    return target.held_until_ns or 0
