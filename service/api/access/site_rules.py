"""What each route is about: something at a site, things of all sites, or people.

Who is limited to sites gets 403 for what is at another one, and for what is about the whole plant. Of a list
they get what is at their sites: the repository that their request has is bounded (`Sessions.within`).
A route that is told of nowhere here is about the whole plant.
"""

from collections.abc import Mapping
from typing import Final
from uuid import UUID

from service.access.permissions import Permission
from service.access.reach import OF_PEOPLE, OF_WHOLE_PLANT
from service.storage.repository import Repository
from service.storage.repository.sites import AtSite

SiteRule = AtSite | str

LISTED: Final = "those of the sites"
"""The answer has what is at the caller's sites. A route that acts asks `Caller.demand_here` of its body."""

WHOLE_PLANT: Final = "all sites"
"""Only who has all sites gets an answer."""

NO_SITE: Final = "-"
"""It is about people, the service's life, or nobody in particular."""

KEYS: Final[Mapping[str, AtSite]] = {
    "/sites/{name}": AtSite.SITE,
    "/motors/{name}": AtSite.MOTOR,
    "/ieds/{name}": AtSite.RELAY,
    "/relays/{name}": AtSite.RELAY,
    "/recordings/{recording_id}": AtSite.RECORDING,
    "/event-reports/{report_id}": AtSite.RECORDING_REQUEST,
    "/deletions/{recording_id}": AtSite.DELETION,
    "/alarms/{alarm_id}": AtSite.ALARM,
}
"""What a part of a path is the key of."""

API: Final = "/api/v1"

LISTS: Final = frozenset(
    {
        *(
            f"{API}{path}"
            for path in (
                "/alarms",
                "/alarms/acknowledgements",
                "/alarms/acknowledgements/undo",
                "/alarms/figures",
                "/alarms/open",
                "/deletions",
                "/event-reports",
                "/exports/alarms",
                "/exports/inspections",
                "/exports/measurements",
                "/exports/recordings",
                "/exports/starts",
                "/exports/trend",
                "/ieds",
                "/inspections/figures",
                "/motors",
                "/recordings",
                "/reports/alarms",
                "/reports/fleet",
                "/sites",
            )
        ),
        "/",
        "/alarms",
        "/alarms/acknowledgements",
        "/alarms/acknowledgements/undo",
        "/live",
        "/plant",
        "/recordings",
        "/relays",
        "/reports",
        "/reports/alarms",
        "/reports/fleet",
        "/reports/motor",
        "/search",
        "/starts",
        "/wall",
    }
)
"""Paths of routes that are LISTED."""


def rule_of(path: str, needed: Permission | None) -> SiteRule:
    """Return what a route is about, by its path, whose parameters are in braces."""
    if needed is None or needed in OF_PEOPLE:
        return NO_SITE
    if needed in OF_WHOLE_PLANT:
        return WHOLE_PLANT
    for part, what in KEYS.items():
        if f"{part}/" in f"{path}/":
            return what
    return LISTED if path in LISTS else WHOLE_PLANT


def is_elsewhere(
    repository: Repository, what: AtSite, parameters: Mapping[str, str], sites: frozenset[str]
) -> bool:
    """Tell whether what a path names is at none of these sites; False where there is no such thing."""
    part = next(part for part, one in KEYS.items() if one is what)
    name = part.partition("{")[2].rstrip("}")
    key = parameters[name]
    return repository.is_elsewhere(what, key if name == "name" else _canonical(key), sites)


def _canonical(key: str) -> str:
    """Return an id as the tables have it; routes read it in any form, and refuse what is none."""
    try:
        return str(UUID(key))
    except ValueError:
        return key
