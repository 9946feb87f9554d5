"""The longest steady stretch of a record in which something happens, and what it is that happens.

A dip, a fuse that blows or a stop shows as an edge: within a cycle a sequence of the voltages or of the
currents is another. The record is cut at its edges. A load that swings has none.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Motor
from core.operation import Operation
from core.quality.circle_diagram import circle_diagram
from core.quality.finding import QualityFinding, finding
from core.quality.operation import LARGEST_OFFSET_A
from core.signals.clarke import CLARKE
from core.signals.terminals import Terminals

STOP_AT_THE_END: Final = "stop at the end"
CUT: Final = frozenset({"steadiness", "phase steadiness", "supply steadiness", STOP_AT_THE_END, "phase loss"})
"""Checks whose failure may come of what happens within the record."""
MOST_EDGES: Final = 3
"""More are a load that swings."""
FEWEST_CYCLES: Final = 8.0
"""Least length of a stretch that is diagnosed."""
SETTLING_CYCLES: Final = 3.0
"""Time behind an edge that currents need until they are steady again."""
EDGE_MARGIN, STOP_MARGIN = 1.0, 0.1
"""Cycles before an edge, and before a stop, that are left out."""
VOLTAGE_EDGE, CURRENT_EDGE = 0.04, 0.3
"""Change within a cycle that is an edge: of the voltage over its median, and over the rated current."""
NO_CURRENT: Final = 0.05
"""Share of its current before below which a phase carries none."""
SENSES: Final = (-1.0, 1.0)
"""Of the frames in which a supply of either order of phases stands still."""
REST: Final = 0.1
"""Length of the currents' space vector, over its median, below which none of them flows."""
SHORTEST_REST_CYCLES, LONGEST_REST_CYCLES = 0.1, 2.0


@dataclass(frozen=True, slots=True)
class Stretch:
    """The longest steady stretch of a record.

    Parameters
    ----------
    terminals : Terminals
        Its quantities.
    event : str
        What happens in the record beside it, in words.
    """

    terminals: Terminals
    event: str

    @property
    def warning(self) -> QualityFinding:
        """The finding that only a stretch of the record is diagnosed."""
        length_s = self.terminals.current_abc.shape[1] / self.terminals.sample_rate_hz
        return QualityFinding(
            "steady stretch", length_s, 0.0, "s", passed=True,
            message=f"{self.event}; the {length_s:.2f} s in which nothing happens are diagnosed",
        )  # fmt: skip


def longest_stretch(terminals: Terminals, motor: Motor) -> Stretch | str | None:
    """Find the longest steady stretch of a record.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, finite.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    Stretch, str or None
        The stretch; what happens in the record, in words, where no stretch is long enough; None where nothing
        happens at one instant.
    """
    if terminals.voltage_ab is None:
        return None
    per_cycle = terminals.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    end = rest_at_the_end(terminals, motor)
    edges = _edges(terminals, motor, per_cycle)
    if end is not None:
        edges = [one for one in edges if one < end - per_cycle] + [end]
    if not 0 < len(edges) <= MOST_EDGES:
        return None
    bounds = [0, *edges, terminals.current_abc.shape[1]]
    settling = ceil(SETTLING_CYCLES * per_cycle)
    pieces = [
        (first + (settling if k else 0), last - (_margin(last, end, per_cycle) if k < len(edges) else 0))
        for k, (first, last) in enumerate(pairwise(bounds))
        if not (end is not None and first == end)
    ]
    first, last = max(pieces, key=lambda one: one[1] - one[0])
    event = _event(terminals, edges, end, per_cycle)
    if last - first < FEWEST_CYCLES * per_cycle:
        return f"{event}; no {FEWEST_CYCLES:g} cycles beside it are steady: record again"
    return Stretch(_between(terminals, first, last), event)


def _margin(edge: int, end: int | None, per_cycle: float) -> int:
    """Return how many samples before an edge are left out: only a stop is known to the sample."""
    return ceil((STOP_MARGIN if edge == end else EDGE_MARGIN) * per_cycle)


def ended(terminals: Terminals, motor: Motor) -> Iterator[QualityFinding]:
    """Check that the currents flow to the end of the record; a stop in its last cycle is told only here.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, finite.
    motor : Motor
        The motor.

    Yields
    ------
    QualityFinding
        A failure.
    """
    begin = rest_at_the_end(terminals, motor)
    if begin is not None:
        rest_s = (terminals.current_abc.shape[1] - begin) / terminals.sample_rate_hz
        yield finding(
            STOP_AT_THE_END, rest_s, 0.0, "s", passed=False, operation=Operation.STOP,
            message=f"the motor is switched off {rest_s * 1e3:.0f} ms before the end of the record",
        )  # fmt: skip


def rest_at_the_end(terminals: Terminals, motor: Motor) -> int | None:
    """Find the sample from which on no current flows, where that is within the last cycles of a record.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, finite.
    motor : Motor
        The motor.

    Returns
    -------
    int or None
        The sample; None where the currents flow to the end, or all channels rest: samples are lost then.
    """
    per_cycle = terminals.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    if float(np.abs(terminals.current_abc).max()) > LARGEST_OFFSET_A:
        return None
    # In three phases the length of the space vector does not pulsate.
    length = np.linalg.norm(CLARKE @ terminals.current_abc, axis=0)
    flowing = np.flatnonzero(length > REST * np.median(length))
    if flowing.size == 0:
        return None
    begin = int(flowing[-1]) + 1
    rest = length.size - begin
    if not SHORTEST_REST_CYCLES * per_cycle <= rest <= LONGEST_REST_CYCLES * per_cycle:
        return None
    live = terminals.voltages[:, begin:]
    return begin if live.size and bool((np.ptp(live, axis=1) > 0.0).any()) else None


def _edges(terminals: Terminals, motor: Motor, per_cycle: float) -> list[int]:
    """Return the samples at which something changes within a cycle: of the voltages, else of the currents."""
    voltage_ab = terminals.voltage_ab
    if voltage_ab is None or voltage_ab.shape[1] < FEWEST_CYCLES * per_cycle:
        return []
    volts = max(float(np.median(np.abs(_course(voltage_ab, per_cycle, sense)))) for sense in SENSES)
    found = _jumps(voltage_ab, per_cycle, VOLTAGE_EDGE * volts)
    if found:
        return found
    rated_A = circle_diagram(motor, motor.nameplate.rated_frequency_Hz).rated_current_A
    current_ab = CLARKE @ terminals.current_abc
    return _jumps(current_ab, per_cycle, CURRENT_EDGE * np.sqrt(3.0) * rated_A)


def _jumps(x_ab: Array, per_cycle: float, limit: float) -> list[int]:
    """Return the samples about which a sequence, averaged over a cycle, jumps by more than a limit."""
    cycle, changes = round(per_cycle), np.zeros(x_ab.shape[1])
    for sense in SENSES:
        size = np.abs(_course(x_ab, per_cycle, sense))
        apart = np.abs(size[cycle:] - size[:-cycle]) / max(limit, 1e-12)
        # The means of the cycles before and behind a sample.
        at = slice(cycle, cycle + apart.size)
        changes[at] = np.maximum(changes[at], apart)
    found: list[int] = []
    while changes.max() > 1.0:
        edge = int(changes.argmax())
        found.append(edge)
        changes[max(0, edge - 2 * cycle) : edge + 2 * cycle] = 0.0
    return sorted(found)


def _course(x_ab: Array, per_cycle: float, sense: float) -> NDArray[np.complex128]:
    """Return the means of a cycle, in a frame that turns with the supply or against it."""
    vector = (x_ab[0] + 1j * x_ab[1]) * np.exp(sense * 2j * np.pi / per_cycle * np.arange(x_ab.shape[1]))
    sums, cycle = np.cumsum(np.concatenate([[0.0], vector])), round(per_cycle)
    return np.asarray((sums[cycle:] - sums[:-cycle]) / cycle, dtype=np.complex128)


def _event(terminals: Terminals, edges: list[int], end: int | None, per_cycle: float) -> str:
    """Say what happens at the first edge that explains the others."""
    rate, cycle, samples = terminals.sample_rate_hz, round(per_cycle), terminals.current_abc.shape[1]
    if end is not None:
        return f"the motor is switched off {(samples - end) / rate * 1e3:.0f} ms before the end of the record"
    first, last = edges[0], edges[-1]
    before = terminals.current_abc[:, : max(first - cycle, cycle)].std(axis=1)
    behind = terminals.current_abc[:, min(last + cycle, samples - cycle) :].std(axis=1)
    gone = behind < NO_CURRENT * before
    if gone.sum() == 1:
        phase = "abc"[int(gone.argmax())]
        since = f"from {last / rate:.2f} s on"
        return f"phase {phase} carries no current {since}: a fuse blows or a wire opens within the record"
    voltage_ab = np.zeros((2, samples)) if terminals.voltage_ab is None else terminals.voltage_ab
    volts = np.max([np.abs(_course(voltage_ab, per_cycle, sense)) for sense in SENSES], axis=0)
    usual, least = float(np.median(volts)), float(volts.min())
    if least < (1.0 - VOLTAGE_EDGE) * usual:
        return f"the voltage dips to {least / usual:.0%} at {first / rate:.2f} s"
    if float(volts.max()) > (1.0 + VOLTAGE_EDGE) * usual:
        return f"the voltage changes by {float(volts.max()) / usual - 1.0:.0%} at {first / rate:.2f} s"
    return f"the load changes at {first / rate:.2f} s"


def _between(terminals: Terminals, first: int, last: int) -> Terminals:
    voltage_ab = terminals.voltage_ab
    return replace(
        terminals,
        current_abc=terminals.current_abc[:, first:last],
        voltages=terminals.voltages[:, first:last],
        voltage_ab=None if voltage_ab is None else voltage_ab[:, first:last],
    )
