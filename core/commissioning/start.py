"""A recording of a start, brought into the form the estimation works on.

The models are played from the instant the current leaves zero. Whether the voltage transformers sit before
or behind the contactor makes no difference: what the voltages were before they could drive a current is
replaced, where the terminals were dead, by the sinusoid that follows, so that a search for the channels'
delay always interpolates a smooth waveform.
"""

from dataclasses import dataclass, replace
from math import ceil, pi, sqrt

import numpy as np

from core.commissioning.errors import CommissioningError
from core.commissioning.onset import current_onset, quiet_offset, voltage_onset
from core.commissioning.wiring import check_wiring
from core.machines.base import Array
from core.machines.candidates import LoadLaw
from core.machines.parameters import ChannelNames, Connection, Nameplate
from core.machines.playback import DELAY_MARGIN_COLUMNS
from core.machines.starting import StartPlayback
from core.machines.supply import Supply, supply
from core.machines.winding_frame import to_winding_frame
from core.quality import FREQUENCY_TOLERANCE, LOWEST_VOLTAGE, rated_current_A, sampled_well
from core.recordings import Recording
from core.signals.clarke import clarke
from core.signals.decimation import decimate
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, fundamental_phasors
from core.signals.sequence import PhaseSequence, sequence_phasors
from core.signals.terminals import Terminals, terminals

HIGHEST_VOLTAGE = 1.3
LOWEST_INRUSH = 1.5
"""Greatest current over the rated one (an order of magnitude, both as space vectors): less is no start."""
HIGHEST_INRUSH = 25.0
"""The same limit: the most that motors draw, 10 times, nearly doubled by the direct part."""
FEWEST_CYCLES = 4.0
"""Length of the start: below it nothing but the leakages and the resistances' sum could be told."""
LONGEST_S = 10.0
FULL_OFFSET_CYCLES, KNOWN_OFFSET_CYCLES = 0.5, 0.1
"""How far T_d is searched either way: modulo a cycle, or about the delay seen between the two onsets."""
SEARCH_SAMPLES_A_CYCLE = 80
_CONTINUED_CYCLES = 2.0
"""Cycles of the live voltage to which the sinusoid before it is fitted."""


@dataclass(frozen=True, slots=True)
class Start:
    """Winding quantities of a start, with a stretch of voltage put before the record.

    Parameters
    ----------
    source : str
        Name of the recording, for messages.
    nameplate : Nameplate
        Rated values of the motor.
    supply : Supply
        Stator voltage on the models' time base.
    voltage_ab, current_ab : ndarray, shape (2, n)
        Winding quantities on one time base that begins `front_s` before the record [V, A].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    front_s : float
        Time put before the record [s].
    switched_on_s : float
        When the motor is switched on, on that time base [s].
    compared : tuple of int
        Samples [first, last) whose currents are compared.
    offset_hint_s : float or None
        T_d between the onsets of voltage and current [s], None where only the current's phase tells it.
    """

    source: str
    nameplate: Nameplate
    supply: Supply
    voltage_ab: Array
    current_ab: Array
    sample_rate_hz: float
    frequency_hz: float
    sequence: PhaseSequence
    front_s: float
    switched_on_s: float
    compared: tuple[int, int]
    offset_hint_s: float | None

    @property
    def cycle_s(self) -> float:
        """One period of the supply [s]."""
        return 1.0 / self.frequency_hz

    @property
    def onset_s(self) -> float:
        """When the motor was switched on, from the record's first sample [s]."""
        return self.switched_on_s - self.front_s

    @property
    def first_column(self) -> int:
        """Column of the supply nearest to the switching, where the models begin."""
        return min(round(self.switched_on_s / self.supply.step_s), self.compared[0] * self.supply.substeps)

    @property
    def compared_s(self) -> tuple[float, float]:
        """The compared part, after the switching [s]."""
        first, last = self.compared
        return (
            first / self.sample_rate_hz - self.switched_on_s,
            (last - 1) / self.sample_rate_hz - self.switched_on_s,
        )

    @property
    def begins_with_the_start(self) -> bool:
        """Whether the compared part shows how the motor was switched on."""
        return self.compared_s[0] < self.cycle_s / 4.0

    @property
    def offset_range_s(self) -> tuple[float, float]:
        """Range in which T_d is searched [s]."""
        if self.offset_hint_s is None:
            reach = FULL_OFFSET_CYCLES * self.cycle_s
            return -reach, reach
        reach = KNOWN_OFFSET_CYCLES * self.cycle_s
        return self.offset_hint_s - reach, self.offset_hint_s + reach

    @property
    def measured_ab(self) -> Array:
        """Current at the compared samples, shape (2, compared) [A]."""
        return self.current_ab[:, slice(*self.compared)]

    @property
    def line_per_winding_current(self) -> float:
        """Line over winding current: sqrt 3 in delta, 1 in star."""
        return sqrt(3.0) if self.nameplate.connection is Connection.DELTA else 1.0

    @property
    def rated_flux_Vs(self) -> float:
        """Length of the stator's flux vector at rated voltage: unit of the switching flux [V s]."""
        star = self.nameplate.connection is Connection.STAR
        volts = self.nameplate.rated_voltage_V * (1.0 if star else sqrt(3.0))
        return volts / self.nameplate.rated_angular_frequency

    def playback(self, load_law: LoadLaw) -> StartPlayback:
        """Return the start's voltages, for any machine.

        Parameters
        ----------
        load_law : LoadLaw
            How the load torque grows with speed.

        Returns
        -------
        StartPlayback
            The voltages to be played through machines.
        """
        return StartPlayback(self.nameplate, self.supply, self.first_column, self.compared, load_law)

    def switching_flux(self, time_offset_s: Array) -> Array:
        """Return the flux that the voltage left between the switching and the models' first column.

        Parameters
        ----------
        time_offset_s : ndarray, shape (candidates,)
            Delay of the currents against the voltages, T_d [s].

        Returns
        -------
        ndarray, shape (candidates, 2)
            Flux on Clarke axes [V s].
        """
        late = self.first_column * self.supply.step_s - self.switched_on_s
        return late * self._voltage_at(self.switched_on_s - time_offset_s).T

    def switched_on_again(self, flux: Array, time_offset_s: float) -> "Start":
        """Return the same start, its instant put right by the switching flux that was fitted.

        Parameters
        ----------
        flux : ndarray, shape (2,)
            The fitted flux [V s].
        time_offset_s : float
            Delay of the currents against the voltages [s].

        Returns
        -------
        Start
            The start from its better instant.
        """
        voltage = self._voltage_at(np.array([self.switched_on_s - time_offset_s]))[:, 0]
        late = float(flux @ voltage) / float(voltage @ voltage)
        instant = self.first_column * self.supply.step_s - late
        farthest = self.cycle_s / 4.0
        instant = float(np.clip(instant, self.switched_on_s - farthest, self.switched_on_s + farthest))
        first = max(self.compared[0], ceil(instant * self.sample_rate_hz))
        return replace(self, switched_on_s=instant, compared=(first, self.compared[1]))

    def _voltage_at(self, time_s: Array) -> Array:
        samples = np.round(time_s * self.sample_rate_hz).astype(np.int64)
        return self.voltage_ab[:, np.clip(samples, 0, self.voltage_ab.shape[1] - 1)]


def start_of(
    recording: Recording,
    nameplate: Nameplate,
    channels: ChannelNames,
    *,
    span_s: tuple[float, float | None] = (0.0, None),
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
    span_s : (float, float or None), optional
        Part of the record whose currents are compared, after the switching instant [s].

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
    onset = _onset(clarke(measured.current_abc), nameplate, per_cycle, source)
    live = voltage_onset(measured.voltage_ab)
    hint = (onset - live) / rate if live > 0 and onset < live + per_cycle * 1.5 else None
    check_wiring(measured, nameplate, source, onset=onset, live=live, hint_s=hint)
    frequency, sequence = _supply_of(measured.voltage_ab[:, live:], rate, nameplate, source)
    current_abc = measured.current_abc - quiet_offset(measured.current_abc, onset, per_cycle)
    # No busbar has a constant part: what the channels show of one would magnetise the model.
    whole = int(_whole_cycles(measured.voltage_ab.shape[1] - live, rate / frequency))
    voltage_ab = measured.voltage_ab - measured.voltage_ab[:, -whole:].mean(axis=1, keepdims=True)
    current_ab, voltage_ab = to_winding_frame(clarke(current_abc), voltage_ab, sequence, nameplate.connection)
    return _framed(
        source, nameplate, current_ab, voltage_ab, rate, frequency, sequence, onset, live, hint, span_s
    )


def thinned(start: Start) -> Start:
    """Return the same start at a lower sample rate, for a search that only has to come near.

    The voltage, smooth by now, passes a filter; of the current every so many-th sample is compared.

    Parameters
    ----------
    start : Start
        The start.

    Returns
    -------
    Start
        The thinned start.
    """
    factor = int(start.sample_rate_hz / start.frequency_hz / SEARCH_SAMPLES_A_CYCLE)
    if factor < 2:
        return start
    voltage_ab = decimate(start.voltage_ab, factor)
    rate = start.sample_rate_hz / factor
    first, last = start.compared
    return replace(
        start,
        supply=supply(voltage_ab, rate, start.frequency_hz, start.supply.phasor),
        voltage_ab=voltage_ab,
        current_ab=start.current_ab[:, ::factor],
        sample_rate_hz=rate,
        compared=(-(-first // factor), (last - 1) // factor + 1),
    )


def _check_samples(measured: Terminals, nameplate: Nameplate, source: str) -> None:
    """Run the quality gate's own checks, less those a motor at rest could not pass."""
    for finding in sampled_well(measured, nameplate):
        if not finding.passed and not finding.name.startswith(("held samples", "duration")):
            raise CommissioningError(
                source,
                finding.name,
                expected=f"a limit of {finding.limit:g} {finding.unit}",
                found=f"{finding.value:g}: {finding.message}",
            )


def _onset(current_ab: Array, nameplate: Nameplate, per_cycle: float, source: str) -> float:
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
    if inrush < LOWEST_INRUSH:
        raise CommissioningError(
            source,
            "start",
            expected=f"an inrush of at least {LOWEST_INRUSH:g} times the rated current",
            found=f"{inrush:.2f} times: no start, a start through a drive, or currents scaled wrongly: check "
            "the current transformers' ratio and rated_power_W",
        )
    if inrush > HIGHEST_INRUSH:
        raise CommissioningError(
            source,
            "start",
            expected=f"an inrush of at most {HIGHEST_INRUSH:g} times the rated current",
            found=f"{inrush:.0f} times: currents scaled wrongly, or another motor's nameplate: check the "
            "current transformers' ratio, the units of the recording, rated_power_W and rated_voltage_V",
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


def _supply_of(live_ab: Array, rate: float, nameplate: Nameplate, source: str) -> tuple[float, PhaseSequence]:
    try:
        frequency = fundamental_frequency(live_ab, rate)
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
            expected=f"{LOWEST_VOLTAGE:.0%} to {HIGHEST_VOLTAGE:.0%} of {nameplate.rated_voltage_V:g} V",
            found=f"{share:.0%}: a soft starter, or voltages scaled wrongly",
        )
    return frequency, phasors.sequence


def _framed(
    source: str,
    nameplate: Nameplate,
    current_ab: Array,
    voltage_ab: Array,
    rate: float,
    frequency: float,
    sequence: PhaseSequence,
    onset: float,
    live: int,
    hint: float | None,
    span_s: tuple[float, float | None],
) -> Start:
    """Replace the dead stretch of voltage; put one in front that any delay can reach back into."""
    cycle = rate / frequency
    seen = None if hint is None else hint * rate
    back = FULL_OFFSET_CYCLES * cycle if seen is None else max(0.0, seen) + KNOWN_OFFSET_CYCLES * cycle
    ahead = FULL_OFFSET_CYCLES * cycle if seen is None else max(0.0, KNOWN_OFFSET_CYCLES * cycle - seen)
    spare = 0.3 * cycle + DELAY_MARGIN_COLUMNS
    front = max(0, ceil(back + spare - onset))
    voltage_ab = np.concatenate(
        [_before(voltage_ab[:, live:], frequency, rate, front + live), voltage_ab[:, live:]], axis=1
    )
    current_ab = np.concatenate([np.zeros((2, front)), current_ab], axis=1)
    begin, end = span_s[0], LONGEST_S if span_s[1] is None else min(span_s[1], LONGEST_S)
    instant = onset + front
    first = ceil(instant + begin * rate) + 1
    last = min(
        current_ab.shape[1] - ceil(ahead + 0.02 * cycle) - DELAY_MARGIN_COLUMNS, round(instant + end * rate)
    )
    if last - first < cycle:
        raise CommissioningError(
            source,
            "duration",
            expected="at least one cycle of current to compare",
            found=f"currents from {begin:g} to {(last - instant) / rate:.3f} s after switching on",
        )
    return Start(
        source=source,
        nameplate=nameplate,
        supply=supply(
            voltage_ab, rate, frequency, sqrt(2.0) * fundamental_phasors(voltage_ab, frequency, rate)
        ),
        voltage_ab=voltage_ab,
        current_ab=current_ab,
        sample_rate_hz=rate,
        frequency_hz=frequency,
        sequence=sequence,
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
