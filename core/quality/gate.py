"""The order of the checks."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from core.machines.base import Array
from core.machines.parameters import Motor, Nameplate
from core.quality import currents, samples, supply
from core.quality.circle_diagram import circle_diagram
from core.quality.finding import QualityFinding, all_passed
from core.quality.magnitude import magnitude
from core.quality.steadiness import steadiness
from core.signals.sequence import PhaseSequence
from core.signals.terminals import Terminals


@dataclass(frozen=True, slots=True)
class Passed:
    """What the checks found out of a record that passed them.

    voltage_ab: as measured or, where none were, assumed: (2, n) [V].  sequence: of the supply.
    """

    voltage_ab: Array
    frequency_hz: float
    sequence: PhaseSequence


def examine(terminals: Terminals, motor: Motor) -> tuple[list[QualityFinding], Passed | None]:
    """All findings up to the first group with a failure, and the record's supply where there is none."""
    found = sampled_well(terminals, motor.nameplate)
    if not all_passed(found):
        return found, None
    feed = supply.feed_of(terminals, motor.nameplate)
    if isinstance(feed, QualityFinding):
        return [*found, feed], None
    for group in _electrical(terminals, feed, motor):
        found += group
        if not all_passed(found):
            return found, None
    return found, Passed(feed.voltage_ab, feed.frequency_hz, feed.phasors.sequence)


def sampled_well(terminals: Terminals, nameplate: Nameplate) -> list[QualityFinding]:
    """Checks on the samples themselves; the rest is computed only where these pass."""
    found = list(samples.extent(terminals, nameplate))
    if all_passed(found):
        found += magnitude(terminals, nameplate)
    if all_passed(found):
        found += samples.clipping(terminals.current_channels, terminals.current_abc)
    return found


def wired_well(terminals: Terminals, motor: Motor, *, timed: bool) -> list[QualityFinding]:
    """Checks on how the channels are connected, of a stretch of any operation; up to the first group that
    fails, and none where the voltages have no one frequency.

    timed: whether currents and voltages are known to be of the same instants. Where they are not, only what
    no delay can look like is checked.
    """
    feed = supply.feed_of(terminals, motor.nameplate)
    if isinstance(feed, QualityFinding):
        return []
    found = list(supply.channels(feed, terminals))
    if all_passed(found):
        seen = currents.currents_of(terminals, feed.frequency_hz)
        found += [*currents.phase_loss(seen, feed), *currents.adding_up(seen, feed)]
        if all_passed(found):
            circle = circle_diagram(motor, feed.frequency_hz)
            found += currents.order(seen, feed, circle) if timed else [currents.rotation(seen, feed)]
    return found


def _electrical(terminals: Terminals, feed: supply.Feed, motor: Motor) -> Iterator[Iterable[QualityFinding]]:
    """Groups of findings, each computed only when asked for."""
    nameplate, per_cycle = motor.nameplate, terminals.sample_rate_hz / feed.frequency_hz
    yield supply.frequency(feed, nameplate)
    yield supply.drive(feed, terminals)
    yield supply.shape(feed, terminals)
    yield supply.channels(feed, terminals)
    yield supply.level(feed, nameplate)
    seen = currents.currents_of(terminals, feed.frequency_hz)
    circle = circle_diagram(motor, feed.frequency_hz)
    yield currents.running(seen, feed, circle)
    yield currents.phase_loss(seen, feed)
    yield currents.level(seen, feed, circle)
    yield samples.holding(terminals.current_channels, terminals.current_abc, per_cycle)
    yield currents.saturation(seen, feed)
    yield currents.adding_up(seen, feed)
    yield currents.order(seen, feed, circle)
    yield steadiness(terminals, feed, seen, circle)
