"""Measures the supply of a motor, and what the motor draws from it, in one recording.

All follows from the samples alone; no machine model is needed.
"""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor, Nameplate
from core.quality import rated_current_A
from core.quality.magnitude import is_far_too_large
from core.quantity_text import plain
from core.recordings import Recording
from core.signals.clarke import CLARKE, clarke, inverse_clarke
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency
from core.signals.sequence import sequence_phasors
from core.signals.terminals import Terminals, terminals
from core.supply.definitions import (
    LARGEST_UNBALANCE,
    derating,
    harmonic_voltage_factor,
    nema_unbalance,
    total_harmonic_distortion,
)
from core.supply.errors import NoSupplyError
from core.supply.figures import SupplyFigures
from core.supply.harmonics import CYCLE_SHORT, FEWEST_CYCLES, HIGHEST_ORDER, Harmonics, harmonics_of

LONGEST_S = 10.0
"""Of a longer record the end is measured: IEC 61000-4-30, 5.1, counts a frequency over ten seconds."""
FREQUENCY_FROM_S = 1.0
"""So much of the record gives the frequency from which its mean frequency is found."""
NO_VOLTAGE, NO_CURRENT = 0.1, 0.005
"""Shares of the rated values below which there is no supply, and no current is drawn."""
STEADY = 0.1
"""Change of the current over a record, of its mean, up to which it counts as steady."""

Array = NDArray[np.float64]


def measure_supply(recording: Recording, motor: Motor, *, frequency_hz: float | None = None) -> SupplyFigures:
    """Measure the supply.

    Parameters
    ----------
    recording : Recording
        A recording with voltages. The motor may stand.
    motor : Motor
        Nameplate, channel names and ratios of the motor.
    frequency_hz : float or None, optional
        Frequency at the record's end, where it is known; else it is estimated [Hz].

    Returns
    -------
    SupplyFigures
        The figures.

    Raises
    ------
    RecordingError
        If the recording lacks channels.
    NoSupplyError
        If it has no voltages or missing samples, is shorter than three cycles, or its voltages are no supply.
    """
    nameplate = motor.nameplate
    measured = terminals(
        recording,
        currents=motor.channels.currents,
        phase_voltages=motor.channels.phase_voltages,
        line_voltages=motor.channels.line_voltages,
        longest_s=LONGEST_S,
        voltage_ratio=motor.transformers.voltage_ratio,
        current_ratio=motor.transformers.current_ratio,
        inside_delta=motor.transformers.inside_delta,
    )
    voltage_ab = _voltages(recording.source, measured, nameplate)
    rate = measured.sample_rate_hz
    if frequency_hz is None:
        frequency_hz = _frequency_hz(recording.source, voltage_ab, rate, nameplate)
    found = _harmonics(recording.source, voltage_ab, measured.current_abc, rate, frequency_hz)
    volts, amps = found.phasors[:3], found.phasors[3:]
    lines_V = np.abs(volts[:, 0])
    if lines_V.mean() < NO_VOLTAGE * nameplate.rated_voltage_V:
        raise NoSupplyError(
            recording.source,
            "voltages",
            expected=f"at least {plain(NO_VOLTAGE * nameplate.rated_voltage_V)} V line to line",
            found=f"{plain(float(lines_V.mean()), 3)} V",
        )
    voltage_harmonics = _most_distorted(volts)
    unbalance = nema_unbalance(lines_V.tolist())
    draws = bool(np.abs(amps[:, 0]).max() > NO_CURRENT * rated_current_A(nameplate))
    current_harmonics = _most_distorted(amps) if draws else ()
    power_W, power_factor = _power(voltage_ab, measured.current_abc, found.samples)
    a, b, c = np.abs(amps[:, 0]).tolist()
    return SupplyFigures(
        frequency_hz=found.frequency_hz,
        line_voltages_V=(float(lines_V[0]), float(lines_V[1]), float(lines_V[2])),
        voltage_unbalance_iec=_unbalance(volts),
        voltage_unbalance_nema=unbalance,
        derating=derating(unbalance),
        voltage_deviation=float(lines_V.mean()) / nameplate.rated_voltage_V - 1.0,
        thd_voltage=total_harmonic_distortion(voltage_harmonics),
        harmonic_voltage_factor=harmonic_voltage_factor(voltage_harmonics),
        voltage_harmonics=voltage_harmonics,
        line_currents_A=(a, b, c) if draws else None,
        current_unbalance=_unbalance(amps) if draws else None,
        thd_current=total_harmonic_distortion(current_harmonics) if draws else None,
        current_harmonics=current_harmonics,
        active_power_W=power_W if draws else None,
        power_factor=power_factor if draws else None,
        duration_s=found.samples / rate,
        reasons=tuple(_reasons(found, unbalance, draws=draws)),
    )


def _voltages(source: str, measured: Terminals, nameplate: Nameplate) -> Array:
    if measured.voltage_ab is None:
        raise NoSupplyError(
            source, "voltages", expected="three phase voltages or two line voltages", found="none"
        )
    if not (np.isfinite(measured.voltage_ab).all() and np.isfinite(measured.current_abc).all()):
        raise NoSupplyError(source, "samples", expected="a value at every instant", found="missing ones")
    if not measured.voltage_ab.size or is_far_too_large(measured, nameplate):
        raise NoSupplyError(
            source,
            "samples",
            expected="values of the order of the rated ones",
            found="none, or far larger ones",
        )
    return measured.voltage_ab


def _frequency_hz(source: str, voltage_ab: Array, rate_hz: float, nameplate: Nameplate) -> float:
    """Return the frequency from which the record's mean frequency is found."""
    last = voltage_ab[:, -max(1, round(FREQUENCY_FROM_S * rate_hz)) :]
    try:
        return fundamental_frequency(last, rate_hz, search_hz=nameplate.frequency_range_Hz)
    except SignalError as error:
        raise NoSupplyError(source, "voltages", expected="those of a supply", found=str(error)) from error


def _harmonics(
    source: str, voltage_ab: Array, current_abc: Array, rate_hz: float, frequency_hz: float
) -> Harmonics:
    """Fit the harmonics of the line voltages ab, bc, ca and of the line currents."""
    cycles = voltage_ab.shape[1] * frequency_hz / rate_hz
    if cycles < FEWEST_CYCLES - CYCLE_SHORT:
        raise NoSupplyError(
            source, "duration", expected=f"at least {FEWEST_CYCLES} cycles", found=f"{cycles:.1f}"
        )
    phase_V = inverse_clarke(voltage_ab)
    lines_V = phase_V - np.roll(phase_V, -1, axis=0)
    return harmonics_of(np.concatenate([lines_V, current_abc]), frequency_hz, rate_hz)


def _most_distorted(phasors: NDArray[np.complex128]) -> tuple[float, ...]:
    """Return the harmonics, over the fundamental, of the quantity that has most of them."""
    shares = [row / row[0] for row in np.abs(phasors) if row[0] > 0.0]
    worst = max(shares, key=lambda row: float(np.sum(row[1:] ** 2)))
    return tuple(worst.tolist())


def _unbalance(phasors: NDArray[np.complex128]) -> float:
    return sequence_phasors(CLARKE @ phasors[:, 0]).unbalance_factor


def _power(voltage_ab: Array, current_abc: Array, samples: int) -> tuple[float, float | None]:
    """Return the active power, and the power factor where any current flows.

    On power-invariant axes without zero sequence the effective apparent power 3 V_e I_e of a motor with three
    wires is the product of the rms values of both space vectors.
    """
    v = voltage_ab[:, -samples:]
    i = clarke(current_abc[:, -samples:])
    v, i = (one - one.mean(axis=1, keepdims=True) for one in (v, i))
    power_W = float(np.einsum("an,an->", v, i)) / samples
    apparent_VA = float(np.sqrt(np.einsum("an,an->", v, v) * np.einsum("an,an->", i, i))) / samples
    return power_W, power_W / apparent_VA if apparent_VA > 0.0 and isfinite(apparent_VA) else None


def _reasons(found: Harmonics, unbalance: float, *, draws: bool) -> list[str]:
    reasons = []
    if unbalance > LARGEST_UNBALANCE:
        reasons.append(
            f"the voltages are {100 * unbalance:.1f} % unbalanced: NEMA MG-1 advises against running the "
            "motor above 5 %, and gives no derating"
        )
    highest = found.phasors.shape[1]
    if highest < HIGHEST_ORDER:
        reasons.append(
            f"the sampling tells harmonics up to the {highest}th alone: distortion and HVF lack those above"
        )
    if not draws:
        reasons.append("no current flows: the motor is switched off")
        return reasons
    amps = np.sqrt(np.mean(np.abs(found.by_block[3:]) ** 2, axis=0))
    change = float(np.ptp(amps) / amps.mean())
    if change > STEADY:
        reasons.append(f"the current changes by {100 * change:.0f} % in the record: its figures are means")
    return reasons
