"""A start of a motor in the form on which the estimation works."""

from dataclasses import dataclass, replace
from math import ceil, sqrt

import numpy as np

from core.machines.air_gap import AirGap, air_gap
from core.machines.base import Array
from core.machines.candidates import LoadLaw
from core.machines.deep_bar_starts import DeepBarStartPlayback
from core.machines.parameters import Connection, MachineParameters, Nameplate
from core.machines.starting import StartPlayback
from core.machines.supply import Supply, supply
from core.signals.decimation import decimate
from core.signals.sequence import PhaseSequence

FULL_OFFSET_CYCLES = 0.5
"""Range in which T_d is searched either way where only the phase of the current determines it."""
KNOWN_OFFSET_CYCLES = 0.1
"""Range either way about the delay between the onsets of voltage and current, where it is seen."""
EFFICIENCY_POWER_FACTOR = 0.75
"""Their usual product at rated power."""
SEARCH_SAMPLES_A_CYCLE = 80
"""Samples a cycle of a thinned start."""


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
    def compared_cycles(self) -> float:
        """Cycles of the supply from the switching to the last compared sample."""
        return self.compared_s[1] / self.cycle_s

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

    def air_gap(self, machine: MachineParameters) -> AirGap:
        """Return flux, torque and slip of the start from the switching on.

        Parameters
        ----------
        machine : MachineParameters
            Parameters of the motor.

        Returns
        -------
        AirGap
            Torque and slip of the whole record.
        """
        first = round(self.switched_on_s * self.sample_rate_hz)
        return air_gap(
            self.voltage_ab[:, first:],
            self.current_ab[:, first:],
            sample_rate_hz=self.sample_rate_hz,
            frequency_hz=self.frequency_hz,
            pole_pairs=self.nameplate.pole_pairs,
            machine=machine,
        )

    @property
    def rated_winding_current_A(self) -> float:
        """About the current of a winding at rated power, rms [A]."""
        plate = self.nameplate
        return plate.rated_power_W / (3.0 * plate.winding_voltage_V * EFFICIENCY_POWER_FACTOR)

    def playback(self, load_law: LoadLaw, *, varies: bool = False) -> StartPlayback:
        """Return the start's voltages, for any machine.

        Parameters
        ----------
        load_law : LoadLaw
            How the load torque grows with speed.
        varies : bool, default False
            Whether machines change from a start to running (deep bars, leakage that saturates), or loads do.

        Returns
        -------
        StartPlayback
            The voltages to be played through machines.
        """
        kind = DeepBarStartPlayback if varies else StartPlayback
        return kind(self.nameplate, self.supply, self.first_column, self.compared, load_law)

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
