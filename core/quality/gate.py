"""The quality gate: it runs the checks in their order, causes before what follows from them.

A person reads the first failure as the reason. So what explains other failures is looked for first: samples
that are missing or repeated, then a motor that starts, stops or stands, then the supply, channel by channel,
and only then what the currents are like.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from core.machines.base import Array
from core.machines.parameters import Motor, Nameplate
from core.quality import currents, samples, supply
from core.quality.circle_diagram import circle_diagram
from core.quality.finding import QualityFinding, all_passed
from core.quality.magnitude import is_far_too_large, magnitude
from core.quality.operation import is_small, operation
from core.quality.steadiness import steadiness
from core.signals.sequence import PhaseSequence
from core.signals.terminals import Terminals


@dataclass(frozen=True, slots=True)
class Passed:
    """What the checks found out of a record that passed them.

    Parameters
    ----------
    voltage_ab : ndarray, shape (2, n)
        Voltages on Clarke axes as measured or, where none were, assumed [V].
    frequency_hz : float
        Supply frequency [Hz].
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    """

    voltage_ab: Array
    frequency_hz: float
    sequence: PhaseSequence


def examine(
    terminals: Terminals, motor: Motor, *, tripped: bool = False
) -> tuple[list[QualityFinding], Passed | None]:
    """Run all checks, up to the first group with a failure.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    tripped : bool, default False
        Whether the relay's trip signal rises in the record.

    Returns
    -------
    findings : list of QualityFinding
        Findings of all checks made.
    passed : Passed or None
        Supply of the record; None where a check failed.
    """
    found: list[QualityFinding] = []
    for group in _sampled(terminals, motor, tripped=tripped):
        found += group
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
    """Check the samples themselves; the rest is computed only where these checks pass.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    list of QualityFinding
        Findings of all checks made.
    """
    found = list(samples.extent(terminals, nameplate))
    if all_passed(found):
        found += magnitude(terminals, nameplate)
    if all_passed(found):
        found += samples.clipping(terminals.current_channels, terminals.current_abc)
    return found


def wired_well(terminals: Terminals, motor: Motor, *, timed: bool) -> list[QualityFinding]:
    """Check how the channels are connected, in a stretch of any operation.

    The checks go on up to the first group that fails; there are none where the voltages have no one
    frequency.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    timed : bool
        Whether currents and voltages are known to be of the same instants. Where they are not, only what no
        delay can look like is checked.

    Returns
    -------
    list of QualityFinding
        Findings of all checks made.
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


def _sampled(terminals: Terminals, motor: Motor, *, tripped: bool) -> Iterator[Iterable[QualityFinding]]:
    """Yield groups of findings on the samples themselves and on what the motor does."""
    per_cycle = terminals.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    yield samples.extent(terminals, motor.nameplate)
    if not is_far_too_large(terminals, motor.nameplate):
        yield samples.sampled_slowly(terminals.voltage_channels, terminals.voltages)
        yield samples.sampled_slowly(terminals.current_channels, terminals.current_abc)
    yield operation(terminals, motor, tripped=tripped)
    yield magnitude(terminals, motor.nameplate)
    yield samples.holding(terminals.voltage_channels, terminals.voltages, per_cycle)
    if not is_small(terminals, motor):
        yield samples.holding(terminals.current_channels, terminals.current_abc, per_cycle)
    yield samples.clipping(terminals.current_channels, terminals.current_abc)


def _electrical(terminals: Terminals, feed: supply.Feed, motor: Motor) -> Iterator[Iterable[QualityFinding]]:
    """Yield groups of findings, each computed only when asked for."""
    nameplate = motor.nameplate
    yield supply.frequency(feed, nameplate)
    yield supply.drive(feed, terminals)
    yield samples.clipping(terminals.voltage_channels, terminals.voltages)
    yield supply.channels(feed, terminals)
    seen = currents.currents_of(terminals, feed.frequency_hz)
    circle = circle_diagram(motor, feed.frequency_hz)
    voltage = list(supply.level(feed, terminals, nameplate))
    if not all_passed(voltage):  # currents of a wrong ratio are told in the same go, at the rated voltage
        voltage += currents.level(seen, supply.at_rated_voltage(feed, nameplate), circle)
    yield voltage
    yield currents.running(seen, feed, circle)
    yield currents.phase_loss(seen, feed)
    yield currents.level(seen, feed, circle)
    yield currents.saturation(seen, feed)
    yield currents.adding_up(seen, feed)
    yield currents.order(seen, feed, circle)
    yield steadiness(terminals, feed, seen, circle)
