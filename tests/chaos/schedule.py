"""What happens when: every trigger and every fault of a run, drawn from its seed before it begins."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

from tests.chaos.plant import SWITCHED, ChaosPlant, ChaosRelay

TRIGGER, OWN_TRIGGER = "trigger", "own-trigger"
"""Asked of the service; made at the relay by another client."""

OWN_SHARE = 0.15
"""Of the records, made at the relay: at those that no client can trigger, and at every third of all, so that
at others each record belongs to a trigger."""

OWN_EVERY = 3


@dataclass(frozen=True, slots=True)
class FaultKind:
    """per_minute: how often.  shortest_s, longest_s: how long one lasts.  of_relay: its victim is a relay."""

    name: str
    per_minute: float
    shortest_s: float = 0.0
    longest_s: float = 0.0
    of_relay: bool = False


OF_THE_SERVICE = (
    FaultKind("kill-service", 0.6),
    FaultKind("kill-gateway", 1.5),
    FaultKind("kill-worker", 1.5),
    FaultKind("freeze-service", 0.5, 1.0, 8.0),
    FaultKind("freeze-gateway", 0.8, 1.0, 14.0),
    FaultKind("freeze-worker", 0.5, 1.0, 8.0),
    FaultKind("disk-full", 0.6, 2.0, 8.0),
    FaultKind("disk-full-and-kill-gateway", 0.4, 3.0, 6.0),
    FaultKind("disk-full-and-kill-service", 0.3, 3.0, 6.0),
    FaultKind("database-locked", 0.8, 1.0, 12.0),
    FaultKind("service-clock-jump", 0.5, 2.0, 8.0),
)
OF_A_RELAY = (
    FaultKind("link-cut", 4.0, of_relay=True),
    FaultKind("link-cut-mid-file", 4.0, of_relay=True),
    FaultKind("link-frozen", 2.0, 1.0, 8.0, of_relay=True),
    FaultKind("link-refused", 2.0, 1.0, 8.0, of_relay=True),
    FaultKind("relays-power-cycle", 0.5, 0.5, 4.0, of_relay=True),
    FaultKind("file-times-jump", 0.5, of_relay=True),
    *(FaultKind(name, 0.6, 2.0, 6.0, of_relay=True) for name in SWITCHED),
)
"""Those of links come oftener, in proportion, where there are more relays than RELAYS_OF_A_RATE."""

OF_POSTGRESQL = (
    FaultKind("database-restarted", 0.5, 0.0, 6.0),
    FaultKind("database-crashed", 0.5, 0.0, 6.0),
    FaultKind("database-connections-ended", 1.5),
    FaultKind("database-link-cut", 3.0),
    FaultKind("database-link-frozen", 0.8, 1.0, 12.0),
)
"""Of a server beside the service, besides those that every database has."""

RELAYS_OF_A_RATE = 10
PAUSE_S = 1.0
"""A fault of a kind ends so long before the next of its kind begins [s]."""


@dataclass(frozen=True, slots=True, order=True)
class Action:
    """At `at_s` from the beginning; `number` tells triggers, and picks a victim where there are several."""

    at_s: float
    kind: str
    relay: str
    length_s: float
    number: int

    def __str__(self) -> str:
        length = f" for {self.length_s:.1f} s" if self.length_s else ""
        return f"{self.at_s:7.1f} s  {self.kind} {self.relay}{length} #{self.number}"


def make_schedule(
    plant: ChaosPlant,
    *,
    seed: int,
    length_s: float,
    recordings: int,
    faults: float = 1.0,
    database: str = "sqlite",
) -> list[Action]:
    """The actions in order. The same arguments give the same schedule.

    faults: so many times the usual number of faults a minute.
    """
    random = Random(seed)
    actions = list(_triggers(plant, random, length_s, recordings))
    for kind in OF_THE_SERVICE:
        actions += _faults(kind, random, length_s, [""], faults)
    growth = max(1.0, len(plant.relays) / RELAYS_OF_A_RATE)
    for kind in OF_A_RELAY:
        often = faults * (growth if kind.name.startswith("link-") else 1.0)
        actions += _faults(kind, random, length_s, _victims(kind, plant), often)
    for kind in OF_POSTGRESQL if database == "postgresql" else ():
        actions += _faults(kind, random, length_s, [""], faults)
    return sorted(actions)


def faults_by_kind(schedule: Sequence[Action]) -> dict[str, int]:
    """How many of each kind of fault."""
    return dict(Counter(action.kind for action in schedule if action.kind not in (TRIGGER, OWN_TRIGGER)))


def _triggers(plant: ChaosPlant, random: Random, length_s: float, recordings: int) -> Iterator[Action]:
    recording = [relay for relay in plant.relays if relay.profile.files is not None]
    by_clients = [relay for relay in recording if relay.profile.points.trigger]
    shared = [
        relay
        for number, relay in enumerate(recording)
        if number % OWN_EVERY == 0 or not relay.profile.points.trigger
    ]
    for number in range(recordings):
        own = random.random() < OWN_SHARE
        relay = _choice(random, shared if own else by_clients)
        at_s = random.uniform(0.0, length_s)
        yield Action(at_s, OWN_TRIGGER if own else TRIGGER, relay.name, 0.0, number)


def _choice(random: Random, relays: list[ChaosRelay]) -> ChaosRelay:
    return relays[random.randrange(len(relays))]


def _victims(kind: FaultKind, plant: ChaosPlant) -> list[str]:
    if kind.name in SWITCHED:
        return [relay.name for relay in plant.relays if relay.switchable]
    if kind.name == "file-times-jump":
        return [relay.name for relay in plant.relays if relay.profile.files is not None]
    return [relay.name for relay in plant.relays]


def _faults(
    kind: FaultKind, random: Random, length_s: float, victims: list[str], often: float
) -> Iterator[Action]:
    """At least one of each kind; two of a kind never at once with the same victim."""
    busy_until_s = dict.fromkeys(victims, 0.0)
    times = max(1, round(kind.per_minute * often * length_s / 60.0))
    for number, drawn_s in enumerate(sorted(random.uniform(0.05, 0.95) * length_s for _ in range(times))):
        victim = victims[random.randrange(len(victims))]
        lasts_s = random.uniform(kind.shortest_s, kind.longest_s)
        at_s = max(drawn_s, busy_until_s[victim])
        busy_until_s[victim] = at_s + lasts_s + PAUSE_S
        if at_s < length_s:
            yield Action(at_s, kind.name, victim, lasts_s, number)
