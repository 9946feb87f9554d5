"""A flood: more alarms within a minute than a person can read become one line that says how many."""

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

EVERYWHERE: Final = None
"""In place of a site: a flood of alarms from several sites."""


@dataclass(frozen=True, slots=True)
class FreshAlarm:
    """An alarm that was raised a moment ago. priority: a flood of minor alarms hides no urgent one."""

    id: str
    site: str | None
    priority: Hashable
    kind: str


@dataclass(frozen=True, slots=True)
class Flood:
    """Alarms of one priority that came together: of a site, or of several ones."""

    site: str | None
    priority: Hashable
    members: Sequence[FreshAlarm]


def floods(fresh: Iterable[FreshAlarm], most: int) -> tuple[Flood, ...]:
    """Return the floods among alarms that were raised within a minute.

    With more than `most` of a priority at a site, they are one flood. Where more than `most` lines of a
    priority are left then, over all sites, they are one flood together. So there are never more than `most`
    lines of a priority.
    """
    by_priority: dict[Hashable, dict[str | None, list[FreshAlarm]]] = defaultdict(lambda: defaultdict(list))
    for alarm in fresh:
        by_priority[alarm.priority][alarm.site].append(alarm)
    found: list[Flood] = []
    for priority, sites in by_priority.items():
        lines = sum(1 if len(members) > most else len(members) for members in sites.values())
        if lines > most:
            everything = [alarm for members in sites.values() for alarm in members]
            found.append(Flood(EVERYWHERE, priority, everything))
        else:
            found += [
                Flood(site, priority, members) for site, members in sites.items() if len(members) > most
            ]
    return tuple(found)


def told(numbers: Mapping[str, int], standing: int) -> str:
    """Return in words how many alarms a flood has, of what kinds, the most frequent first, and what stands.

    numbers: how many of each kind.
    """
    parts = ", ".join(f"{number} {kind}" for kind, number in Counter(numbers).most_common())
    return f"{sum(numbers.values())} alarms at once: {parts}; {standing} of them stand"


def is_over(standing_members: int, most: int) -> bool:
    """Tell whether a flood has run off: those of its alarms that still stand can be read one by one."""
    return standing_members <= most / 2.0
