"""Motors of the fleet under their sites."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from service.web.fleet.rows import FleetRow, counts, digest
from service.web.words import STATE_WORDS


@dataclass(frozen=True, slots=True)
class SiteGroup:
    """The rows of a site, as written. key, words: of its heading; both empty where all stand together."""

    site: str
    key: str
    words: str
    rows: Sequence[Markup]


def site_groups(rows: Sequence[FleetRow], written: Sequence[Markup]) -> list[SiteGroup]:
    """Return the rows by site, the site with what needs attention first before the others."""
    of_site: dict[str, list[int]] = {}
    for number, row in enumerate(rows):
        of_site.setdefault(row.site, []).append(number)
    return [
        SiteGroup(
            site,
            f"site-{digest(site)}",
            _words([rows[number] for number in numbers]),
            [written[number] for number in numbers],
        )
        for site, numbers in of_site.items()
    ]


def _words(rows: Sequence[FleetRow]) -> str:
    """Return how many motors are in which state; each counts once."""
    total = f"{len(rows)} motor{'' if len(rows) == 1 else 's'}"
    return ", ".join(
        [total, *(f"{number} {STATE_WORDS[state]}" for state, number in counts(rows).items() if number)]
    )
