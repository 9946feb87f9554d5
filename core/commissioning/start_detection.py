"""Detection of a motor's start in a recording.

The models are played from the instant at which the current leaves zero. The voltage transformers may sit
before or behind the contactor. Where the terminals were dead before, the voltages are replaced by the
sinusoid that follows. A search for the delay of the channels then always interpolates a smooth waveform.
"""

from dataclasses import dataclass
from math import ceil, pi, sqrt

import numpy as np

from core.commissioning.errors import CommissioningError
from core.commissioning.onset import current_onset, quiet_offset, voltage_onset
from core.commissioning.start import FULL_OFFSET_CYCLES, KNOWN_OFFSET_CYCLES, Start
from core.commissioning.wiring import check_wiring
from core.machines.base import Array
from core.machines.parameters import ChannelNames, Nameplate, Transformers
from core.machines.playback import DELAY_MARGIN_COLUMNS
from core.machines.supply import supply
from core.machines.winding_frame import to_winding_frame
from core.quality import FREQUENCY_TOLERANCE, LOWEST_VOLTAGE, rated_current_A, sampled_well
from core.quality.operation import Course, course_of
from core.quality.ratios import appended, current_advice, voltage_advice
from core.quantity_text import plain, with_unit
from core.recordings import Channel, Recording
from core.signals.clarke import clarke
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, fundamental_phasors
from core.signals.sequence import PhaseSequence, sequence_phasors
from core.signals.terminals import Terminals, terminals

AS_RECORDED = Transformers()

HIGHEST_VOLTAGE = 1.3
"""Highest voltage accepted, over the rated one."""
LOWEST_INRUSH = 1.5
"""Least inrush of a start: the greatest current over the rated one, both as space vectors."""
LOWEST_BY_STEPS = 0.5
"""The same of a wound rotor with resistance at its rings."""
FIRST_STEP_CYCLES = 2.0
"""Cycles after the switching that are the first step's for sure."""
USUAL_INRUSH = (2.0, 12.0)
"""Range of the inrush of most motors, over the rated current."""
HIGHEST_INRUSH = 25.0
"""Highest inrush accepted. Motors draw up to 10 times, and the decaying direct part nearly doubles it."""
FEWEST_CYCLES = 4.0
"""Least length of a start. A shorter one identifies the leakages and the sum of the resistances at most."""
LONGEST_S = 10.0
"""Longest part of a start that is compared."""
_CONTINUED_CYCLES = 2.0
"""Cycles of the live voltage to which the sinusoid before it is fitted."""


@dataclass(frozen=True, slots=True)
class _Detected:
    """Winding quantities of a recording with the instants of its start.

    Parameters
    ----------
    source : str
        Name of the recording, for messages.
    nameplate : Nameplate
        Rated values of the motor.
    voltage_ab, current_ab : ndarray, shape (2, n)
        Winding quantities from the record's first sample on [V, A].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    onset : float
        Sample at which the current leaves zero.
    live : int
        First sample at which the voltage is there.
    offset_hint_s : float or None
        T_d between the onsets of voltage and current [s], None where the onsets do not show it.
    """

    source: str
    nameplate: Nameplate
    voltage_ab: Array
    current_ab: Array
    sample_rate_hz: float
    frequency_hz: float
    sequence: PhaseSequence
    onset: float
    live: int
    offset_hint_s: float | None


def start_of(
    recording: Recording,
    nameplate: Nameplate,
    channels: ChannelNames,
    *,
    transformers: Transformers = AS_RECORDED,
    span_s: tuple[float, float | None] = (0.0, None),
    by_steps: bool = False,
) -> Start:
    """Find the start in a recording and check that it is one.

    Parameters
    ----------
    recording : Recording
        The recording.
    nameplate : Nameplate
        Rated values of the motor.
    channels : ChannelNames
        Names of the channels.
    transformers : Transformers, optional
        Ratios of the instrument transformers, where the recording does not tell them right.
    span_s : (float, float or None), optional
        Part of the record whose currents are compared, after the switching instant [s].
    by_steps : bool, default False
        Whether a wound rotor may start by steps of resistance, with a current near the rated one.

    Returns
    -------
    Start
        The start.

    Raises
    ------
    RecordingError
        If the recording lacks channels.
    CommissioningError
        If it holds no start from rest that can be used.
    """
    measured = terminals(
        recording,
        currents=channels.currents,
        phase_voltages=channels.phase_voltages,
        line_voltages=channels.line_voltages,
        voltage_ratio=transformers.voltage_ratio,
        current_ratio=transformers.current_ratio,
        inside_delta=transformers.inside_delta,
    )
    source, rate = recording.source, measured.sample_rate_hz
    if measured.voltage_ab is None:
        raise CommissioningError(
            source,
            "voltages",
            expected="three phase voltages or two line voltages beside the currents",
            found="none: the parameters follow from what current a voltage drives",
        )
    _check_samples(measured, nameplate, source)
    per_cycle = rate / nameplate.rated_frequency_Hz
    current_ab, least = clarke(measured.current_abc), LOWEST_BY_STEPS if by_steps else LOWEST_INRUSH
    onset = _onset(current_ab, nameplate, measured.current_channels, per_cycle, source, least)
    if by_steps:
        # Later steps draw more: the rise is that of the first one's current.
        first_step = current_ab[:, : ceil(onset + FIRST_STEP_CYCLES * per_cycle)]
        onset = current_onset(first_step, per_cycle) or onset
    _check_direct(course_of(measured.current_abc, per_cycle), nameplate, source, by_steps=by_steps)
    live = voltage_onset(measured.voltage_ab)
    hint = (onset - live) / rate if live > 0 and onset < live + per_cycle * 1.5 else None
    check_wiring(measured, nameplate, source, onset=onset, live=live, hint_s=hint)
    frequency, sequence = _supply_of(
        measured.voltage_ab[:, live:], rate, nameplate, measured.voltage_channels, source
    )
    current_abc = measured.current_abc - quiet_offset(measured.current_abc, onset, per_cycle)
    # A busbar has no constant voltage. An offset of the channels would magnetise the model.
    whole = int(_whole_cycles(measured.voltage_ab.shape[1] - live, rate / frequency))
    voltage_ab = measured.voltage_ab - measured.voltage_ab[:, -whole:].mean(axis=1, keepdims=True)
    current_ab, voltage_ab = to_winding_frame(clarke(current_abc), voltage_ab, sequence, nameplate.connection)
    detected = _Detected(
        source=source,
        nameplate=nameplate,
        voltage_ab=voltage_ab,
        current_ab=current_ab,
        sample_rate_hz=rate,
        frequency_hz=frequency,
        sequence=sequence,
        onset=onset,
        live=live,
        offset_hint_s=hint,
    )
    return _framed(detected, span_s)


def _check_samples(measured: Terminals, nameplate: Nameplate, source: str) -> None:
    """Run those checks of the quality gate that a motor at rest can pass."""
    for finding in sampled_well(measured, nameplate):
        if not finding.passed and not finding.name.startswith(("held samples", "duration")):
            raise CommissioningError(
                source,
                finding.name,
                expected=f"a limit of {plain(finding.limit, 6)} {finding.unit}",
                found=f"{plain(finding.value, 6)}: {finding.message}",
            )


def _check_direct(course: Course | None, nameplate: Nameplate, source: str, *, by_steps: bool) -> None:
    """Check that the motor is switched on once, at full voltage, and stays on: only that can be played."""
    if course is None:
        return
    if course.is_rest[-1]:
        found = "a motor that is switched off again within it: record all of a start"
    elif course.interruption is not None:
        at_s = course.interruption / nameplate.rated_frequency_Hz
        found = (
            f"a current that is interrupted {at_s:.2f} s after the recording's beginning, as from star to "
            "delta: such a start is not supported"
        )
    elif not (course.is_direct or by_steps):
        found = (
            "a current that rises slowly, as through a soft starter, a drive or a reduced voltage: such a "
            "start is not supported"
        )
    else:
        return
    raise CommissioningError(source, "start", expected="one direct start", found=found)


def _onset(
    current_ab: Array,
    nameplate: Nameplate,
    channels: tuple[Channel, ...],
    per_cycle: float,
    source: str,
    least: float,
) -> float:
    length = np.hypot(current_ab[0], current_ab[1])
    inrush = float(length.max()) / (sqrt(3.0) * rated_current_A(nameplate))
    onset = current_onset(current_ab, per_cycle)
    if onset is None:
        cycle = max(1, round(per_cycle))
        first, last = (float(np.mean(part**2)) for part in (length[:cycle], length[-cycle:]))
        found = (
            "a motor already running: in steady running its resistances, inductances and inertia are not "
            "identifiable"
            if first < 1.5 * last
            else "a start that began before the record: lengthen the pre-trigger time"
        )
        raise CommissioningError(
            source,
            "start",
            expected="a motor at rest at the record's first sample: no current, then its start",
            found=found,
        )
    rated = rated_current_A(nameplate)
    usual = (USUAL_INRUSH[0] * rated, USUAL_INRUSH[1] * rated)
    advice = current_advice(inrush * rated, usual, rated, channels)
    if inrush < least:
        raise CommissioningError(
            source,
            "start",
            expected=f"an inrush of at least {least:g} times the rated current",
            found=f"{inrush:.2f} times: no start, a start through a drive, or currents scaled wrongly: check "
            f"the current transformers' ratio and rated_power_W{appended(advice)}",
        )
    if inrush > HIGHEST_INRUSH:
        raise CommissioningError(
            source,
            "start",
            expected=f"an inrush of at most {HIGHEST_INRUSH:g} times the rated current",
            found=f"{inrush:.0f} times: currents scaled wrongly, or another motor's nameplate: check the "
            "current transformers' ratio, the units of the recording, rated_power_W and rated_voltage_V; "
            f"{advice}",
        )
    duration = (length.size - onset) / per_cycle
    if duration < FEWEST_CYCLES:
        raise CommissioningError(
            source,
            "duration",
            expected=f"at least {FEWEST_CYCLES:g} cycles after switching on, better all of the start",
            found=f"{duration:.1f} cycles: the record is too short",
        )
    return max(0.0, onset)


def _supply_of(
    live_ab: Array, rate: float, nameplate: Nameplate, channels: tuple[Channel, ...], source: str
) -> tuple[float, PhaseSequence]:
    try:
        frequency = fundamental_frequency(live_ab, rate, search_hz=nameplate.frequency_range_Hz)
    except SignalError as error:
        raise CommissioningError(
            source, "voltages", expected="a supply of one frequency", found=str(error)
        ) from error
    rated = nameplate.rated_frequency_Hz
    if abs(frequency / rated - 1.0) > FREQUENCY_TOLERANCE:
        raise CommissioningError(
            source,
            "frequency",
            expected=f"the rated {rated:g} Hz within {FREQUENCY_TOLERANCE:.0%}",
            found=f"{frequency:.2f} Hz: fed by a drive?",
        )
    phasors = sequence_phasors(fundamental_phasors(live_ab, frequency, rate))
    strong = max(abs(phasors.positive), abs(phasors.negative))
    share = strong * sqrt(3.0) / nameplate.rated_voltage_V
    if not LOWEST_VOLTAGE <= share <= HIGHEST_VOLTAGE:
        raise CommissioningError(
            source,
            "voltage",
            expected=f"{LOWEST_VOLTAGE:.0%} to {HIGHEST_VOLTAGE:.0%} of "
            f"{with_unit(nameplate.rated_voltage_V, 'V', 6)}",
            found=f"{plain(share, 2)} of it: a soft starter, or voltages scaled wrongly; "
            + voltage_advice(share * nameplate.rated_voltage_V, nameplate, channels),
        )
    return frequency, phasors.sequence


def _framed(detected: _Detected, span_s: tuple[float, float | None]) -> Start:
    """Replace the dead stretch of voltage, and put one in front that any delay can reach back into."""
    rate, frequency, live = detected.sample_rate_hz, detected.frequency_hz, detected.live
    onset, hint = detected.onset, detected.offset_hint_s
    cycle = rate / frequency
    seen = None if hint is None else hint * rate
    back = FULL_OFFSET_CYCLES * cycle if seen is None else max(0.0, seen) + KNOWN_OFFSET_CYCLES * cycle
    ahead = FULL_OFFSET_CYCLES * cycle if seen is None else max(0.0, KNOWN_OFFSET_CYCLES * cycle - seen)
    spare = 0.3 * cycle + DELAY_MARGIN_COLUMNS
    front = max(0, ceil(back + spare - onset))
    live_ab = detected.voltage_ab[:, live:]
    voltage_ab = np.concatenate([_before(live_ab, frequency, rate, front + live), live_ab], axis=1)
    current_ab = np.concatenate([np.zeros((2, front)), detected.current_ab], axis=1)
    begin, end = span_s[0], LONGEST_S if span_s[1] is None else min(span_s[1], LONGEST_S)
    instant = onset + front
    first = ceil(instant + begin * rate) + 1
    last = min(
        current_ab.shape[1] - ceil(ahead + 0.02 * cycle) - DELAY_MARGIN_COLUMNS, round(instant + end * rate)
    )
    if last - first < cycle:
        raise CommissioningError(
            detected.source,
            "duration",
            expected="at least one cycle of current to compare",
            found=f"currents from {begin:g} to {(last - instant) / rate:.3f} s after switching on",
        )
    return Start(
        source=detected.source,
        nameplate=detected.nameplate,
        supply=supply(
            voltage_ab, rate, frequency, sqrt(2.0) * fundamental_phasors(voltage_ab, frequency, rate)
        ),
        voltage_ab=voltage_ab,
        current_ab=current_ab,
        sample_rate_hz=rate,
        frequency_hz=frequency,
        sequence=detected.sequence,
        front_s=front / rate,
        switched_on_s=instant / rate,
        compared=(first, last),
        offset_hint_s=hint,
    )


def _before(live_ab: Array, frequency: float, rate: float, samples: int) -> Array:
    """Return the sinusoid of the first live cycles over the samples before them, (2, samples) [V]."""
    known = live_ab[:, : round(_CONTINUED_CYCLES * rate / frequency)]
    phasors = sqrt(2.0) * fundamental_phasors(known, frequency, rate)
    turn = 2j * pi * frequency / rate * np.arange(-samples, 0)
    return np.asarray((phasors[:, np.newaxis] * np.exp(turn)).real)


def _whole_cycles(samples: int, samples_per_cycle: float) -> int:
    return round(int(samples / samples_per_cycle) * samples_per_cycle)
