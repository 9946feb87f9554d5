"""Relays as the pages show them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.api.context import ApiContext
from service.api.pages import decode, encode
from service.api.relays.report_lengths import report_length_of
from service.configuration.settings import Settings
from service.plant.report_length import ReportLength
from service.storage import Repository
from service.storage.records import Alarm, GatewayEntry, IedEntry, LinkChange, LinkFigures, RelayFindings
from service.storage.records.overviews import RelayOverview
from service.storage.states import ClockQuality, LinkState
from service.web.addresses import address
from service.web.choices import site_names
from service.web.relays.certificates import CertificateEnd, certificate_ends
from service.web.relays.links import LinkHistory, link_history

MOST_SHOWN: Final = 100
MOST_CHANGES: Final = 50

LINK_LOOKS: Final[Mapping[LinkState, str]] = {
    LinkState.UP: "healthy",
    LinkState.DOWN: "fault",
    LinkState.QUARANTINED: "watch",
    LinkState.UNKNOWN: "unknown",
}
"""The class of each state's colour and icon."""

USED: Final[Sequence[tuple[str, str]]] = (
    ("trigger", "Trigger"),
    ("trigger_action", "Operated as"),
    ("control_model", "Control model"),
    ("record_made", "Record made"),
    ("record_number", "Record number"),
    ("records_told_by", "Records announced by"),
    ("report_control", "Report control"),
    ("events_directory", "Events directory"),
    ("text_reports", "Text reports"),
)
"""What the service uses of a relay, by its names in RelayFindings.acquisition."""


@dataclass(frozen=True, slots=True)
class RelayChoice:
    """Which relays somebody wants to see, as the address of the page says it."""

    site: str | None = None
    link: LinkState | None = None
    text: str | None = None
    cursor: str | None = None

    @property
    def path(self) -> str:
        """Return the address of the page that shows them."""
        return address("/relays", **self._query, cursor=self.cursor)

    def with_link(self, link: LinkState | None) -> str:
        """Return the address of those with another state of the link."""
        return address("/relays", **{**self._query, "link": link})

    def further(self, cursor: str) -> str:
        """Return the address of the next page."""
        return address("/relays", **self._query, cursor=cursor)

    @property
    def is_filtered(self) -> bool:
        """Tell whether some relays are left out."""
        return any(one is not None for one in (self.site, self.link, self.text))

    @property
    def _query(self) -> dict[str, object]:
        return {"site": self.site, "link": self.link, "text": self.text}


@dataclass(frozen=True, slots=True)
class RelayClock:
    """A relay's clock less the service's [s], as of its latest comparison; is_off: more than is allowed."""

    offset_s: float
    uncertainty_s: float
    quality: ClockQuality
    measured_ns: int
    is_off: bool

    @property
    def words(self) -> str:
        """Return how far it is off."""
        within = f"± {self.uncertainty_s:.2g} s"
        if abs(self.offset_s) <= self.uncertainty_s:
            return f"right within {max(abs(self.offset_s), self.uncertainty_s):.2g} s"
        return f"{abs(self.offset_s):.3g} s {'ahead' if self.offset_s > 0 else 'behind'} ({within})"


@dataclass(frozen=True, slots=True)
class RelayLine:
    """A relay in the list."""

    overview: RelayOverview
    clock: RelayClock | None
    certificate: CertificateEnd | None

    @property
    def link_state(self) -> str:
        """Return the state of its link in words."""
        return str(self.overview.relay.link_state)

    @property
    def look(self) -> str:
        """Return the class of its colour and icon."""
        return LINK_LOOKS[self.overview.relay.link_state]


@dataclass(frozen=True, slots=True)
class LinkCount:
    """How many relays have a link in a state, and where they are listed."""

    words: str
    look: str
    number: int
    path: str
    is_here: bool


@dataclass(frozen=True, slots=True)
class RelayList:
    """What the page of all relays shows."""

    choice: RelayChoice
    counts: Sequence[LinkCount]
    lines: Sequence[RelayLine]
    sites: Sequence[str]
    next_path: str | None
    gateways: Sequence[GatewayEntry]


@dataclass(frozen=True, slots=True)
class RelayDetails:
    """What the page of one relay shows. is_held: it is set aside now.

    report_length: by its latest record; None where none was read.
    """

    line: RelayLine
    in_service: bool
    is_held: bool
    gateway: str | None
    figures: LinkFigures
    history: LinkHistory
    picture: str
    changes: Sequence[LinkChange]
    further_changes: str | None
    alarms: Sequence[Alarm]
    findings: RelayFindings | None
    certificates: Sequence[CertificateEnd]
    used: Sequence[tuple[str, str | None]] = field(default=())
    report_length: ReportLength | None = None

    @property
    def entry(self) -> IedEntry:
        """Return the relay itself."""
        return self.line.overview.relay


def relay_list(repository: Repository, settings: Settings, choice: RelayChoice) -> RelayList:
    """Read what the page of all relays shows. Raises ProblemError for a cursor that is none."""
    numbers = repository.link_states()
    found = repository.relay_overviews(
        limit=MOST_SHOWN,
        after=decode(choice.cursor, str),
        site=choice.site,
        link=choice.link,
        text=choice.text,
    )
    return RelayList(
        choice=choice,
        counts=[
            LinkCount(
                str(state),
                LINK_LOOKS[state],
                numbers[state],
                choice.with_link(state),
                state is choice.link,
            )
            for state in LINK_LOOKS
            if numbers.get(state)
        ],
        lines=[_line(overview, settings) for overview in found.items],
        sites=site_names(repository),
        next_path=None if found.next is None else choice.further(encode(found.next)),
        gateways=repository.gateways(),
    )


def relay_details(
    context: ApiContext, name: str, *, days: int, cursor: str | None, now_ns: int
) -> RelayDetails:
    """Read what the page of one relay shows. Raises NotFoundError, ProblemError for a cursor that is none."""
    repository, settings = context.repository, context.settings
    overview = repository.relay_overview(name)
    changes = repository.link_changes(name, limit=MOST_CHANGES, after=decode(cursor, int, str))
    from_ns = now_ns - days * NANOSECONDS_PER_DAY
    history = link_history(repository.link_history(name, from_ns=from_ns), days=days, now_ns=now_ns)
    findings = repository.relay_findings(name)
    here = address("/relays", name)
    return RelayDetails(
        line=_line(overview, settings),
        in_service=repository.is_in_service(name),
        is_held=overview.quarantine is not None and overview.quarantine.holds(now_ns),
        gateway=repository.gateway_of(name),
        figures=repository.link_figures(name),
        history=history,
        picture=history.picture(name),
        changes=changes.items,
        further_changes=None
        if changes.next is None
        else address(here, days=days, cursor=encode(changes.next)) + "#changes",
        alarms=repository.standing_alarms(name),
        findings=findings,
        certificates=certificate_ends(settings.relays.get(name)),
        used=()
        if findings is None
        else [(words, _text(findings.acquisition.get(key))) for key, words in USED],
        report_length=report_length_of(context, overview),
    )


def _line(overview: RelayOverview, settings: Settings) -> RelayLine:
    ends = certificate_ends(settings.relays.get(overview.relay.name))
    return RelayLine(
        overview, clock_of(overview.relay, settings.alarms.clock_off_s), ends[0] if ends else None
    )


def clock_of(relay: IedEntry, most_s: float) -> RelayClock | None:
    """Return how far a relay's clock is off; None before the first comparison."""
    if relay.clock_offset_ns is None or relay.clock_measured_ns is None or relay.clock_quality is None:
        return None
    offset_s = relay.clock_offset_ns / NANOSECONDS_PER_SECOND
    return RelayClock(
        offset_s=offset_s,
        uncertainty_s=(relay.clock_uncertainty_ns or 0) / NANOSECONDS_PER_SECOND,
        quality=relay.clock_quality,
        measured_ns=relay.clock_measured_ns,
        is_off=abs(offset_s) > most_s or relay.clock_quality is ClockQuality.FAILED,
    )


def _text(value: object) -> str | None:
    if isinstance(value, list):
        return ", ".join(map(str, value)) or None
    return None if value is None else str(value)
