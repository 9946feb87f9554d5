"""The lists of alarms that the page shows: active ones, those set aside, and all that ever were."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from service.api.pages import decode, encode
from service.storage import NotFoundError, Repository
from service.storage.alarm_transitions import possible_for_people
from service.storage.records import Alarm, Page
from service.storage.states import AlarmEvent, AlarmState
from service.web.addresses import address
from service.web.choices import site_names

MOST_SHOWN: Final = 50
"""So many alarms are on a page. The form that acknowledges all of them, with a comment, is small enough."""


class AlarmTab(StrEnum):
    """Which alarms the page shows."""

    ACTIVE = "active"
    SET_ASIDE = "set-aside"
    HISTORY = "history"


STATES: Final[Mapping[AlarmTab, Collection[AlarmState]]] = {
    AlarmTab.ACTIVE: (
        AlarmState.UNACKNOWLEDGED,
        AlarmState.RETURNED_UNACKNOWLEDGED,
        AlarmState.ACKNOWLEDGED,
    ),
    AlarmTab.SET_ASIDE: (AlarmState.SHELVED, AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE),
}

TAB_WORDS: Final[Mapping[AlarmTab, str]] = {
    AlarmTab.ACTIVE: "Active",
    AlarmTab.SET_ASIDE: "Shelved and set aside",
    AlarmTab.HISTORY: "History",
}


@dataclass(frozen=True, slots=True)
class AlarmChoice:
    """Which alarms somebody wants to see, as the address of the page says it."""

    tab: AlarmTab = AlarmTab.ACTIVE
    site: str | None = None
    text: str | None = None
    motor: str | None = None
    relay: str | None = None
    cursor: str | None = None

    @property
    def path(self) -> str:
        """Return the address of the page that shows them."""
        return address("/alarms", **self._query, cursor=self.cursor)

    def at(self, tab: AlarmTab) -> str:
        """Return the address of another list, with the same filters."""
        return address("/alarms", **{**self._query, "show": _shown(tab)})

    def further(self, cursor: str | None) -> str | None:
        """Return the address of the next page; None at the end."""
        return None if cursor is None else address("/alarms", **self._query, cursor=cursor)

    @property
    def is_filtered(self) -> bool:
        """Tell whether some alarms are left out."""
        return any(one is not None for one in (self.site, self.text, self.motor, self.relay))

    @property
    def _query(self) -> dict[str, object]:
        return {
            "show": _shown(self.tab),
            "site": self.site,
            "text": self.text,
            "motor": self.motor,
            "relay": self.relay,
        }


@dataclass(frozen=True, slots=True)
class TabLink:
    """A list that one may go to. number: how many alarms it has; None where nobody counts."""

    words: str
    path: str
    number: int | None
    is_here: bool


@dataclass(frozen=True, slots=True)
class AlarmLine:
    """An alarm in a list. acknowledgeable: whether somebody may take notice of it in its state."""

    alarm: Alarm
    acknowledgeable: bool

    @property
    def look(self) -> str:
        """Return which colour and icon it has."""
        return look_of(self.alarm)


@dataclass(frozen=True, slots=True)
class AlarmList:
    """What the page shows. refused: alarms that could not be acknowledged just now, as they are by now."""

    choice: AlarmChoice
    tabs: Sequence[TabLink]
    lines: Sequence[AlarmLine]
    next_path: str | None
    sites: Sequence[str]
    refused: Sequence[Alarm]
    calling: int

    @property
    def acknowledgeable(self) -> bool:
        """Tell whether there is anything to acknowledge."""
        return any(line.acknowledgeable for line in self.lines)


def alarm_list(repository: Repository, choice: AlarmChoice, *, refused: Sequence[str] = ()) -> AlarmList:
    """Read what the page shows. Raises ProblemError for a cursor that is none."""
    numbers = repository.open_alarm_states(sites=None if choice.site is None else [choice.site])
    found = _page(repository, choice)
    return AlarmList(
        choice=choice,
        tabs=[
            TabLink(TAB_WORDS[tab], choice.at(tab), _number(numbers, tab, choice), tab is choice.tab)
            for tab in AlarmTab
        ],
        lines=[line_of(alarm) for alarm in found.items],
        next_path=choice.further(None if found.next is None else encode(found.next)),
        sites=site_names(repository),
        refused=_known(repository, refused),
        calling=numbers.get(AlarmState.UNACKNOWLEDGED, 0),
    )


def line_of(alarm: Alarm) -> AlarmLine:
    """Return an alarm as a list shows it."""
    return AlarmLine(alarm, AlarmEvent.ACKNOWLEDGED in possible_for_people(alarm.state))


def look_of(alarm: Alarm) -> str:
    """Return the class of an alarm's colour and icon: only what calls for somebody has a colour."""
    if alarm.state is not AlarmState.UNACKNOWLEDGED:
        return "quiet"
    return {"critical": "fault", "high": "fault", "medium": "watch"}.get(alarm.priority.value, "unknown")


def _page(repository: Repository, choice: AlarmChoice) -> Page[Alarm]:
    if choice.tab is AlarmTab.HISTORY:
        after = decode(choice.cursor, int, str)
        return repository.alarms(
            limit=MOST_SHOWN,
            after=after,
            site=choice.site,
            motor=choice.motor,
            relay=choice.relay,
            text=choice.text,
        )
    return repository.open_alarms(
        limit=MOST_SHOWN,
        after=decode(choice.cursor, int, int, str),
        site=choice.site,
        motor=choice.motor,
        relay=choice.relay,
        states=STATES[choice.tab],
        text=choice.text,
    )


def _number(numbers: Mapping[AlarmState, int], tab: AlarmTab, choice: AlarmChoice) -> int | None:
    if tab is AlarmTab.HISTORY or any(one is not None for one in (choice.text, choice.motor, choice.relay)):
        return None
    return sum(numbers.get(state, 0) for state in STATES[tab])


def _shown(tab: AlarmTab) -> str | None:
    return None if tab is AlarmTab.ACTIVE else tab.value


def _known(repository: Repository, alarm_ids: Sequence[str]) -> Sequence[Alarm]:
    found = []
    for one in alarm_ids:
        try:
            found.append(repository.alarm(one))
        except NotFoundError:
            continue
    return found
