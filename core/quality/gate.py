"""The quality gate: it runs the checks in their order, causes before what follows from them.

A person reads the first failure as the reason. So what explains other failures is looked for first: samples
that are missing or repeated, then a motor that starts, stops or stands, then the supply, channel by channel,
and only then what the currents are like.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from core.machines.base import Array
from core.machines.feeder import at_the_motor, has_feeder
from core.machines.parameters import CurrentPosition, Motor, Nameplate
from core.quality import current_sum, currents, samples, supply
from core.quality.circle_diagram import circle_diagram
from core.quality.copied import copied
from core.quality.counts import counts
from core.quality.finding import QualityFinding, all_passed
from core.quality.magnitude import is_far_too_large, magnitude
from core.quality.operation import is_small, operation
from core.quality.steadiness import steadiness
from core.quality.stretches import ended
from core.signals.sequence import PhaseSequence
from core.signals.terminals import Terminals


@dataclass(frozen=True, slots=True)
class Passed:
    """What the checks found out of a record that passed them.

    Parameters
    ----------
    current_abc : ndarray, shape (3, n)
        Line currents of the motor: without those of capacitors that its file tells of [A].
    voltage_ab : ndarray, shape (2, n)
        Voltages on Clarke axes as measured or, where none were, assumed; behind a cable of the file [V].
    frequency_hz : float
        Supply frequency [Hz].
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    """

    current_abc: Array
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
    terminals = _at_the_motor(terminals, motor)
    feed = supply.feed_of(terminals, motor.nameplate)
    if isinstance(feed, QualityFinding):
        return [*found, feed], None
    for group in _electrical(terminals, feed, motor):
        found += group
        if not all_passed(found):
            return found, None
    return found, Passed(terminals.current_abc, feed.voltage_ab, feed.frequency_hz, feed.phasors.sequence)


def _at_the_motor(terminals: Terminals, motor: Motor) -> Terminals:
    """Return the motor's own currents and voltages, where its file tells of capacitors or of a cable."""
    if terminals.voltage_ab is None or not has_feeder(motor):
        return terminals
    current_abc, voltage_ab = at_the_motor(
        motor, terminals.current_abc, terminals.voltage_ab, terminals.sample_rate_hz
    )
    return replace(terminals, current_abc=current_abc, voltage_ab=voltage_ab)


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
        found += counts(terminals, nameplate)
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
        found += currents.phase_loss(seen, feed)
        if is_sum_measured(terminals, motor):
            found += current_sum.adding_up(seen, feed, motor)
        if all_passed(found):
            circle = circle_diagram(motor, feed.frequency_hz)
            found += currents.order(seen, feed, circle) if timed else [currents.rotation(seen, feed)]
    return found


def is_sum_measured(terminals: Terminals, motor: Motor) -> bool:
    """Whether the sum of the currents tells anything.

    That of computed currents and of differences is zero, and a neutral carries that of its motor.
    """
    inside = motor.transformers.current_position is CurrentPosition.INSIDE_DELTA
    return terminals.computed_current is None and not inside and not motor.neutral


def _sampled(terminals: Terminals, motor: Motor, *, tripped: bool) -> Iterator[Iterable[QualityFinding]]:
    """Yield groups of findings on the samples themselves and on what the motor does."""
    per_cycle = terminals.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    yield samples.extent(terminals, motor.nameplate)
    yield counts(terminals, motor.nameplate)
    yield copied(terminals)
    if not is_far_too_large(terminals, motor.nameplate):
        yield samples.sampled_slowly(terminals.voltage_channels, terminals.voltages)
        yield samples.sampled_slowly(terminals.current_channels, terminals.current_abc)
    yield operation(terminals, motor, tripped=tripped)
    yield ended(terminals, motor)
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
    yield current_sum.saturation(seen, feed, motor)
    if is_sum_measured(terminals, motor):
        yield current_sum.adding_up(seen, feed, motor)
    yield current_sum.transformers(terminals, motor)
    yield currents.order(seen, feed, circle)
    yield steadiness(terminals, feed, seen, circle)
