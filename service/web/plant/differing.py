"""Relays that are not as their files say: what differs, of those that were visited."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.storage import Repository
from service.storage.records.overviews import RelayOverview

MOST_SHOWN: Final = 20
MOST_EACH: Final = 3


@dataclass(frozen=True, slots=True)
class DifferingRelay:
    """A relay with the first of its differences: what the SCL says, and what the relay has."""

    overview: RelayOverview
    first: Sequence[tuple[str, str | None, str | None]]

    @property
    def further(self) -> int:
        """Return how many differences there are besides."""
        return max((self.overview.differences or 0) - len(self.first), 0)


@dataclass(frozen=True, slots=True)
class FilesAndRelays:
    """What the files say against what the relays say.

    visited: relays of which something is known, of `relays` in all.  more: there are more than are shown.
    """

    visited: int
    relays: int
    differing: Sequence[DifferingRelay]
    more: bool


def files_and_relays(repository: Repository) -> FilesAndRelays:
    """Read what differs."""
    visited, relays = repository.visited_relays()
    found = repository.relay_overviews(limit=MOST_SHOWN, differing=True)
    return FilesAndRelays(
        visited=visited,
        relays=relays,
        differing=[_differing(repository, overview) for overview in found.items],
        more=found.next is not None,
    )


def _differing(repository: Repository, overview: RelayOverview) -> DifferingRelay:
    findings = repository.relay_findings(overview.relay.name)
    first = [] if findings is None else findings.differences[:MOST_EACH]
    return DifferingRelay(
        overview,
        [(str(one.get("kind")), _text(one.get("expected")), _text(one.get("found"))) for one in first],
    )


def _text(value: object) -> str | None:
    return None if value is None else str(value)
