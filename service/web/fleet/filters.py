"""Which motors the fleet shows: the filters of its address."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from service.web.addresses import address
from service.web.fleet.rows import FleetRow
from service.web.fleet.states import FleetState
from service.web.words import STATE_WORDS

LONGEST = 200
BY_SITE = "site"
"""What an address says of motors that stand under their sites."""


@dataclass(frozen=True, slots=True)
class FleetFilter:
    """What a motor must be to be shown; all of it where something is given.

    text: words that are all in the motor's name, description, site, relay, state or kind of change.
    not_assessed: a part that no record could judge.  by_site: whether motors stand under their sites.
    """

    site: str | None = None
    state: FleetState | None = None
    text: str = ""
    not_assessed: str = ""
    by_site: bool = False

    @property
    def is_empty(self) -> bool:
        """Tell whether all motors are shown."""
        return replace(self, by_site=False) == FleetFilter()

    def chosen(self, rows: Iterable[FleetRow]) -> list[FleetRow]:
        """Return the motors that are shown, in their order."""
        words = self.text.casefold().split()
        return [row for row in rows if self._shows(row) and all(word in _searched(row) for word in words)]

    def address(self) -> str:
        """Return where this is shown."""
        return address(
            "/",
            site=self.site,
            state=self.state,
            text=self.text,
            not_assessed=self.not_assessed,
            group=BY_SITE if self.by_site else None,
        )

    def with_part(self, part: str) -> "FleetFilter":
        """Return the filter of all motors of which a part is not assessed."""
        return FleetFilter(not_assessed=part, by_site=self.by_site)

    def with_state(self, state: FleetState | None) -> "FleetFilter":
        """Return the same with another state."""
        return replace(self, state=state)

    def _shows(self, row: FleetRow) -> bool:
        return (
            (self.site is None or row.site == self.site)
            and (self.state is None or self.state is row.state)
            and (not self.not_assessed or self.not_assessed in row.not_assessed)
        )


def _searched(row: FleetRow) -> str:
    states = (STATE_WORDS[state] for state in row.states)
    return "\n".join((row.name, row.description, row.site, row.ied, row.kind, *states)).casefold()
