"""Space vectors of a record in the frame of its supply, where the fundamental stands still.

Means over a cycle, taken twice, leave the forward fundamental and what swings about it: offsets, the other
sequence and all harmonics have their zeros there. So little is left that lines are fitted at once, and such a
fit equals the joint least-squares fit of fundamental, harmonics and sidebands to the samples.
"""

from dataclasses import dataclass, replace
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.acceptance import Accepted
from core.machines.base import Array
from core.machines.steady_state import ComplexArray
from core.machines.winding_frame import to_winding_frame
from core.quality.circle_diagram import circle_diagram
from core.quality.steadiness import UNSTEADY_CURRENT, UNSTEADY_VOLTAGE
from core.quality.swing import without_swing
from core.rotor.spikes import without_spikes
from core.signals.clarke import clarke
from core.signals.terminals import terminals

LONGEST_S = 30.0
"""Of a longer record only the end is examined: over minutes no load keeps its slip."""
POINTS_A_CYCLE = 4.0
REFERENCE_S = 1.0
"""Length of the record's end against which the rest is steady or not."""
SLOW_DEGREE, SLOW_FROM_S = 3, 3.0
"""Degree of the polynomials that follow frequency and load through a record, and the length from which it is
so high: what is slower than the sidebands is no sideband."""


@dataclass(frozen=True, slots=True)
class Baseband:
    """Forward space vectors of a stretch of steady running, in the frame that turns with its voltage.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Times, zero in the middle [s].
    angular_frequency : ndarray, shape (n,)
        Angular frequency of the supply [rad/s].
    voltage, current : ndarray of complex, shape (n,)
        Winding quantities, peak of the power-invariant space vector [V, A].
    cycle_s : float
        Length of the means [s].
    is_whole : bool
        Whether it is the whole recording, or as much as is ever examined.
    spikes : int
        Number of samples that were replaced.
    """

    time_s: Array
    angular_frequency: Array
    voltage: ComplexArray
    current: ComplexArray
    cycle_s: float
    is_whole: bool
    spikes: int

    @property
    def duration_s(self) -> float:
        """Length of the samples that the means are taken from [s]."""
        return float(self.time_s[-1] - self.time_s[0]) + 2.0 * self.cycle_s

    @property
    def span_s(self) -> float:
        """Time from the first mean to the last [s]."""
        return float(self.time_s[-1] - self.time_s[0])

    def gain(self, frequency_hz: Array) -> Array:
        """Return what the means leave of lines at a distance from the fundamental.

        Parameters
        ----------
        frequency_hz : ndarray
            Distances [Hz].

        Returns
        -------
        ndarray
            Gains, the same on both sides.
        """
        return np.asarray(np.sinc(frequency_hz * self.cycle_s) ** 2)


def baseband_of(accepted: Accepted) -> Baseband:
    """Take the longest steady stretch at the end of a record into the frame of its supply.

    Parameters
    ----------
    accepted : Accepted
        A record that passed the quality gate.

    Returns
    -------
    Baseband
        The stretch. Where no voltages were recorded, they are those that the gate assumes: constant ones.
    """
    case, motor = accepted.case, accepted.case.motor
    whole = terminals(
        accepted.recording,
        currents=motor.channels.currents,
        phase_voltages=None if case.voltages_assumed else motor.channels.phase_voltages,
        line_voltages=None if case.voltages_assumed else motor.channels.line_voltages,
        longest_s=LONGEST_S,
        voltage_ratio=motor.transformers.voltage_ratio,
        current_ratio=motor.transformers.current_ratio,
        inside_delta=motor.transformers.inside_delta,
    )
    rate, per_cycle = case.sample_rate_hz, case.sample_rate_hz / case.frequency_hz
    current_abc, voltages = whole.current_abc, whole.voltages
    first = _first_finite(np.vstack([current_abc, voltages]))
    current_abc, spikes = without_spikes(current_abc[:, first:], per_cycle)
    current_ab = clarke(current_abc)
    if case.voltages_assumed:
        voltage_ab = np.zeros_like(current_ab)
    else:
        voltage_ab = whole.voltage_axes @ without_spikes(voltages[:, first:], per_cycle)[0]
    current_ab, voltage_ab = to_winding_frame(
        current_ab, voltage_ab, case.sequence, motor.nameplate.connection
    )
    middle, current = _cycle_means(current_ab, per_cycle)
    voltage = _cycle_means(voltage_ab, per_cycle)[1]
    carrier = 2.0 * pi * case.frequency_hz
    found = Baseband(
        time_s=middle / rate,
        angular_frequency=np.full(middle.size, carrier),
        voltage=voltage,
        current=current,
        cycle_s=1.0 / case.frequency_hz,
        is_whole=first == 0,
        spikes=spikes,
    )
    return _aligned(_steady_end(found, accepted), accepted)


def slow(time_s: Array, x: Array) -> Array:
    """Return the slow part of a course: a polynomial in time.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Times [s].
    x : ndarray, shape (n,)
        The course.

    Returns
    -------
    ndarray, shape (n,)
        Its slow part.
    """
    scaled, degree = _scaled(time_s)
    fit = np.polynomial.legendre.legfit(scaled, x, degree)
    return np.asarray(np.polynomial.legendre.legval(scaled, fit))


def _first_finite(x: Array) -> int:
    missing = np.flatnonzero(~np.isfinite(x).all(axis=0))
    return int(missing[-1]) + 1 if missing.size else 0


def _cycle_means(x_ab: Array, per_cycle: float) -> tuple[Array, ComplexArray]:
    """Return the middles (in samples) and the forward space vector there, averaged over a cycle twice.

    The integral between samples is linear, so that the means are over exact cycles whatever the rate.
    """
    n = x_ab.shape[1]
    k = np.arange(n)
    turned = (x_ab[0] + 1j * x_ab[1]) * np.exp(-2j * pi / per_cycle * k)
    edge, half = np.arange(n + 1) - 0.5, per_cycle / 2.0

    def mean(values: ComplexArray, edges: Array, middles: Array) -> ComplexArray:
        total = np.concatenate([[0.0], np.cumsum(values)])
        until, since = (np.interp(middles + side, edges, total) for side in (half, -half))
        return np.asarray((until - since) / per_cycle, dtype=np.complex128)

    inner = np.arange(ceil(half), n - ceil(half), dtype=np.float64)
    once = mean(turned, edge, inner)
    step = max(1, int(per_cycle / POINTS_A_CYCLE))
    middles = np.arange(inner[0] + ceil(half), inner[-1] - ceil(half), step)
    return middles, mean(once, np.append(inner - 0.5, inner[-1] + 0.5), middles)


def _steady_end(whole: Baseband, accepted: Accepted) -> Baseband:
    """Cut off what comes before the last moment at which voltage or current are far from those of the end."""
    case = accepted.case
    end = whole.time_s > whole.time_s[-1] - REFERENCE_S
    circle = circle_diagram(case.motor, case.frequency_hz)
    rated_A = np.sqrt(3.0) * circle.rated_current_A / case.line_per_winding_current
    step_s = float(whole.time_s[1] - whole.time_s[0])
    drawn = without_swing(np.abs(whole.current), step_s, case.frequency_hz).real
    moved = np.abs(drawn - drawn[end].mean()) > UNSTEADY_CURRENT * rated_A
    volts = np.abs(whole.voltage)
    moved |= np.abs(volts - volts[end].mean()) > UNSTEADY_VOLTAGE * volts[end].mean()
    first = int(np.flatnonzero(moved & ~end)[-1]) + 1 if (moved & ~end).any() else 0
    # The means of a cycle before and after a change hold a part of it.
    first = first and first + ceil(whole.cycle_s / step_s)
    time_s = whole.time_s[first:]
    return replace(
        whole,
        time_s=time_s - (time_s[0] + time_s[-1]) / 2.0,
        angular_frequency=whole.angular_frequency[first:],
        voltage=whole.voltage[first:],
        current=whole.current[first:],
        is_whole=whole.is_whole and first == 0,
    )


def _aligned(steady: Baseband, accepted: Accepted) -> Baseband:
    """Turn the frame with the slow part of the voltage's angle, or the current's where none is known."""
    case = accepted.case
    leading = steady.current if case.voltages_assumed else steady.voltage
    scaled, degree = _scaled(steady.time_s)
    fit = np.polynomial.legendre.legfit(scaled, np.unwrap(np.angle(leading)), degree)
    angle = np.polynomial.legendre.legval(scaled, fit)
    half_s = (steady.time_s[-1] - steady.time_s[0]) / 2.0
    faster = np.polynomial.legendre.legval(scaled, np.polynomial.legendre.legder(fit)) / half_s
    turn = np.exp(-1j * angle)
    current, voltage = steady.current * turn, steady.voltage * turn
    if case.voltages_assumed:
        assumed, drawn = accepted.phasors.voltage.forward, accepted.phasors.current.forward
        voltage = np.full(current.size, abs(current.mean()) * assumed / drawn)
        # The current leads this frame: the voltage is ahead of it as in the phasors of the record.
    return replace(
        steady, angular_frequency=steady.angular_frequency + faster, voltage=voltage, current=current
    )


def _scaled(time_s: Array) -> tuple[Array, int]:
    """Return the times between -1 and 1, and the degree of what is slow."""
    length_s = float(time_s[-1] - time_s[0])
    scaled: NDArray[np.float64] = (2.0 * time_s - time_s[0] - time_s[-1]) / length_s
    return scaled, SLOW_DEGREE if length_s >= SLOW_FROM_S else 1
