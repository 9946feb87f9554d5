"""Routes and digests of the settings, in words."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import time

from service.configuration.notifications import DAYS, Digest, NotificationSettings, Route
from service.web.words import phrase


@dataclass(frozen=True, slots=True)
class RouteWords:
    """A route: which alarms it tells, to whom, and when."""

    name: str
    alarms: str
    events: str
    channels: Sequence[str]
    hours: str
    escalations: Sequence[str]


@dataclass(frozen=True, slots=True)
class DigestWords:
    """A summary at a time of day."""

    when: str
    channels: Sequence[str]
    sites: str


def route_words(settings: NotificationSettings) -> Sequence[RouteWords]:
    """Return the routes in their order."""
    return [_route(number, route, settings.time_zone) for number, route in enumerate(settings.routes, 1)]


def digest_words(settings: NotificationSettings) -> Sequence[DigestWords]:
    """Return the digests in their order."""
    return [_digest(digest, settings.time_zone) for digest in settings.digests]


def _route(number: int, route: Route, zone: str) -> RouteWords:
    return RouteWords(
        name=route.name or f"route {number}",
        alarms="; ".join(
            (
                _chosen("priority", route.priorities, "every priority"),
                _chosen("site", route.sites, "every site and the service"),
                _chosen("kind", route.kinds, "every kind"),
            )
        ),
        events=", ".join(route.events),
        channels=route.channels,
        hours=_hours(route, zone),
        escalations=[
            f"after {one.after_min:g} min without acknowledgement: {', '.join(one.channels)}"
            for one in route.escalations
        ],
    )


def _chosen(what: str, values: Sequence[str] | None, otherwise: str) -> str:
    return otherwise if values is None else f"{what} {', '.join(map(phrase, values))}"


def _hours(route: Route, zone: str) -> str:
    midnight = time(0, 0)
    always = route.begin == route.end == midnight
    if always and set(route.days) == set(DAYS):
        return "at all times"
    days = "every day" if set(route.days) == set(DAYS) else ", ".join(route.days)
    hours = "" if always else f" {route.begin:%H:%M} to {route.end:%H:%M}"
    outside = "when they begin" if route.outside_hours == "wait" else "not by this route"
    return f"{days}{hours} ({zone}); at other times {outside}"


def _digest(digest: Digest, zone: str) -> DigestWords:
    day = "every day" if digest.period == "daily" else f"every {digest.day}"
    return DigestWords(
        when=f"{day} at {digest.at:%H:%M} ({zone})",
        channels=digest.channels,
        sites="all sites" if digest.sites is None else ", ".join(digest.sites),
    )
