"""What is wrong with the notifications and reports of a plant that the settings alone do not show."""

import os
from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime, time, timedelta
from importlib.util import find_spec
from itertools import product
from zoneinfo import ZoneInfo

from core.error_words import nearest, shown
from service.alarms.kinds import AlarmKind
from service.configuration.channel_secrets import ChannelSecretError, require_secrets, unknown_channels
from service.configuration.channels import AppriseChannel, CommandChannel, MailChannel, WebhookChannel
from service.configuration.environment import VARIABLES
from service.configuration.notifications import DAYS, NotificationSettings, Priority, Route
from service.configuration.problems import ENVIRONMENT, Problem
from service.configuration.reports import ReportSettings
from service.notifications.hours import is_within

URGENT: tuple[Priority, ...] = ("critical", "high")
"""Somebody should be told of these at any time."""

MONDAY = datetime(2026, 1, 5, tzinfo=ZoneInfo("UTC"))
"""The beginning of some week."""


def route_problems(settings: NotificationSettings, sites: Iterable[str], source: str) -> list[Problem]:
    """Return the sites and kinds of alarms that are named and not there: nobody would be told of them."""
    known_sites, known_kinds = tuple(sites), tuple(kind.value for kind in AlarmKind)
    named = [
        *((f"routes.{number}.sites", one.sites, known_sites) for number, one in enumerate(settings.routes)),
        *((f"routes.{number}.kinds", one.kinds, known_kinds) for number, one in enumerate(settings.routes)),
        *((f"digests.{number}.sites", one.sites, known_sites) for number, one in enumerate(settings.digests)),
    ]
    return _unknown("notifications", named, source)


def _unknown(
    table: str, named: Sequence[tuple[str, Sequence[str] | None, Sequence[str]]], source: str
) -> list[Problem]:
    """Return a problem for each name that is not known. named: fields with their names and those known."""
    return [
        Problem(
            source,
            f"{table}.{field}",
            f"one of {', '.join(known) or 'none'}",
            shown(name),
            nearest(name, known),
        )
        for field, names, known in named
        for name in names or ()
        if name not in known
    ]


def report_problems(
    settings: ReportSettings, sites: Iterable[str], motors: Iterable[str], source: str
) -> list[Problem]:
    """Return the sites and motors of reports by mail that are named and not there."""
    known_sites, known_motors = tuple(sites), tuple(motors)
    named = [
        *((f"mails.{number}.sites", one.sites, known_sites) for number, one in enumerate(settings.mails)),
        *((f"mails.{number}.motors", one.motors, known_motors) for number, one in enumerate(settings.mails)),
    ]
    return _unknown("reports", named, source)


def channel_problems(settings: NotificationSettings, source: str) -> Iterator[Problem]:
    """Yield secrets that are missing, programs that cannot be run, and variables of no channel."""
    for name, channel in settings.channels.items():
        field = f"notifications.channels.{name}"
        try:
            require_secrets(name, channel)
        except ChannelSecretError as error:
            where, _, rest = str(error).removeprefix(f"channel {name}: ").partition("expected ")
            expected, _, found = rest.partition(", found ")
            named = " ".join(filter(None, (field, where.strip(" :"))))
            yield Problem(source, named, expected or str(error), found or "something else")
        if isinstance(channel, CommandChannel) and not os.access(channel.command[0], os.X_OK):
            found = f"{channel.command[0]}, which is none"
            yield Problem(source, f"{field}.command", "a program that can be run", found)
    for variable in unknown_channels(settings.channels, VARIABLES):
        expected = "the name of a channel in capitals at its end"
        yield Problem(ENVIRONMENT, variable, expected, "no channel of this name")


def warnings(settings: NotificationSettings, sites: Iterable[str]) -> Iterator[str]:
    """Yield what can be used and is probably not meant: passwords in clear, alarms that call nobody."""
    for name, channel in settings.channels.items():
        if isinstance(channel, MailChannel) and channel.security == "none" and channel.user is not None:
            yield f"channel {name}: its password goes over the network in clear: set security"
        is_open = isinstance(channel, WebhookChannel) and (channel.url or "").startswith("http:")
        if is_open:
            yield f"channel {name}: messages go over the network in clear: use https://"
        if isinstance(channel, AppriseChannel) and not _has_apprise():
            yield f'channel {name}: needs pip install "statorwatch[notify]"'
    if not settings.channels:
        return
    for priority, site in product(URGENT, (*sites, None)):
        at = _uncovered(settings, site, priority)
        if at is not None:
            where = "of the service itself" if site is None else f"at {site}"
            when = f"on {DAYS[at.weekday()]} at {at:%H:%M}"
            yield f"notifications: nobody is told of {priority} alarms {where}, such as {when}"
            return


def _uncovered(settings: NotificationSettings, site: str | None, priority: Priority) -> datetime | None:
    """Return a time of the week at which no route tells all alarms of a priority at a site."""
    routes = [route for route in settings.routes if _takes(route, site, priority)]
    clocks = {time(0, 0), *(route.begin for route in routes), *(route.end for route in routes)}
    for day in range(7):
        for clock in sorted(clocks):
            at = datetime.combine(MONDAY.date() + timedelta(days=day), clock, MONDAY.tzinfo)
            if not any(route.outside_hours == "wait" or is_within(route, at) for route in routes):
                return at
    return None


def _takes(route: Route, site: str | None, priority: Priority) -> bool:
    return (
        route.kinds is None
        and "raised" in route.events
        and (route.sites is None or site in route.sites)
        and (route.priorities is None or priority in route.priorities)
    )


def _has_apprise() -> bool:

    return find_spec("apprise") is not None
