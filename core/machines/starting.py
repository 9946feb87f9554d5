"""Starts from rest of symmetrical machines that all differ: measured voltages played through each candidate.

`playback` knows one motor and asks which fault it has; here every candidate has its own resistances,
inductances, inertia and load. The stepping is the same: the kernel knows one inertia for a batch, so a
candidate's rotor flux is counted in units in which its torque accelerates that inertia as its own torque
does its own inertia,

    psi_r' = (J_ref / J) psi_r,   i_r as it is:   (J_ref / p) dw/dt = p (psi_r' x i_r) - (J_ref / J) T_load
"""

from dataclasses import dataclass

import numpy as np

from core.machines.base import Array
from core.machines.batch import find_rates, play
from core.machines.candidates import LoadLaw
from core.machines.parameters import MAGNETISING_OVER_SELF, MachineParameters, Nameplate
from core.machines.playback import DELAY_MARGIN_COLUMNS, Trajectories
from core.machines.stepping import Comparison, InitialState, MachineRates, SteppedVoltage, Track
from core.machines.supply import Supply

REFERENCE_RUN_UP_S = 0.3
"""Energy of the kernel's reference inertia at synchronous speed, over rated power [s].

Any value of the order of real motors keeps the matrices well scaled.
"""


@dataclass(frozen=True, slots=True)
class StartCandidates:
    """A batch of machines and their starts; the parameters are those of MachineParameters.

    Parameters
    ----------
    stator_resistance_ohm : ndarray, shape (candidates,)
        R_s [ohm].
    rotor_resistance_ohm : ndarray, shape (candidates,)
        R_r', referred to the stator [ohm].
    stator_leakage_H : ndarray, shape (candidates,)
        L_ls [H].
    rotor_leakage_H : ndarray, shape (candidates,)
        L_lr', referred to the stator [H].
    stator_self_inductance_H : ndarray, shape (candidates,)
        L_s [H].
    inertia_kgm2 : ndarray, shape (candidates,)
        J [kg m^2].
    load_level : ndarray, shape (candidates,)
        Load torque over rated torque.
    time_offset_s : ndarray, shape (candidates,)
        Delay of the currents against the voltages, T_d [s].
    switching_flux_Vs : ndarray, shape (candidates, 2)
        Stator flux on the Clarke axes where the playback begins [V s]: what the voltage up to there, or poles
        that close one after the other, left in the windings.
    """

    stator_resistance_ohm: Array
    rotor_resistance_ohm: Array
    stator_leakage_H: Array
    rotor_leakage_H: Array
    stator_self_inductance_H: Array
    inertia_kgm2: Array
    load_level: Array
    time_offset_s: Array
    switching_flux_Vs: Array

    def __len__(self) -> int:
        return self.load_level.size


def start_candidate(
    machine: MachineParameters, load_level: float, time_offset_s: float = 0.0
) -> StartCandidates:
    """Return a batch of one, switched on where the playback begins.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    load_level : float
        Load torque over rated torque.
    time_offset_s : float, default 0.0
        Delay of the currents against the voltages, T_d [s].

    Returns
    -------
    StartCandidates
        The batch.
    """
    return StartCandidates(
        np.array([machine.stator_resistance_ohm]),
        np.array([machine.rotor_resistance_ohm]),
        np.array([machine.stator_leakage_H]),
        np.array([machine.rotor_leakage_H]),
        np.array([machine.stator_self_inductance_H]),
        np.array([machine.inertia_kgm2]),
        np.array([load_level]),
        np.array([time_offset_s]),
        np.zeros((1, 2)),
    )


class StartPlayback:
    """Measured voltages from the instant of switching on; any number of machines at rest.

    Unlike a stator's window it may begin between two samples of the record.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    supply : Supply
        Stator voltage on the model's time base.
    switched_on : int
        Column of the supply's time base at which the motor is switched on.
    compared : tuple of int
        Samples of the record [first, last) whose currents are wanted, none of them before the switching.
    load_law : LoadLaw, default LoadLaw.CONSTANT
        How the load torque grows with speed.
    """

    def __init__(
        self,
        nameplate: Nameplate,
        supply: Supply,
        switched_on: int,
        compared: tuple[int, int],
        load_law: LoadLaw = LoadLaw.CONSTANT,
    ) -> None:
        first, last = (sample * supply.substeps for sample in compared)
        if not switched_on <= first < last:
            raise ValueError(
                f"samples compared: expected some from column {switched_on} on, found {compared}"
            )
        self.nameplate = nameplate
        self.supply = supply
        self.load_law = load_law
        end = last - supply.substeps + 1
        self._feed = SteppedVoltage(
            supply.voltage, switched_on, end, supply.step_s, 1, supply.angular_frequency
        )
        self._wanted = slice(first - switched_on, None, supply.substeps)
        reach = DELAY_MARGIN_COLUMNS - 1
        self.latest_offset_s = (switched_on - reach) * supply.step_s
        self.earliest_offset_s = -(supply.voltage.shape[0] - end - reach) * supply.step_s
        w_b, p = nameplate.rated_angular_frequency, nameplate.pole_pairs
        self._torque_per_pole_pair = nameplate.rated_torque_Nm / p / w_b**load_law.value
        self._reference_inertia = 2.0 * REFERENCE_RUN_UP_S * nameplate.rated_power_W / (w_b / p) ** 2

    def squared_error(self, candidates: StartCandidates, measured_ab: Array) -> Array:
        """Sum the squared distances of the model's current to the measured one (5.1).

        Parameters
        ----------
        candidates : StartCandidates
            The batch of hypotheses.
        measured_ab : ndarray, shape (2, compared)
            Measured currents on Clarke axes at the compared samples [A].

        Returns
        -------
        ndarray, shape (candidates,)
            Sums [A^2]; infinite for a candidate whose currents are not numbers.
        """
        difference = self.trajectories(candidates).current - measured_ab
        error = np.einsum("cak,cak->c", difference, difference)
        return np.where(np.isfinite(error), error, np.inf)

    def trajectories(self, candidates: StartCandidates) -> Trajectories:
        """Return currents and speed of every candidate at the compared samples.

        Parameters
        ----------
        candidates : StartCandidates
            The batch of hypotheses.

        Returns
        -------
        Trajectories
            Currents and speeds.

        Raises
        ------
        ValueError
            If a time offset reaches beyond the voltages there are.
        """
        n, delays = len(candidates), candidates.time_offset_s
        self.require_voltages(delays)
        share = self._reference_inertia / candidates.inertia_kgm2
        load = np.zeros((n, 3))
        load[:, int(self.load_law)] = candidates.load_level * self._torque_per_pole_pair * share
        flux = np.zeros((5, n))
        flux[:2] = candidates.switching_flux_Vs.T
        gain = self.nameplate.pole_pairs**2 / self._reference_inertia
        machines = MachineRates(np.empty((n, 5, 5)), np.empty((n, 5, 5)), load, gain)
        find_rates(*_circuits(candidates, share), machines.decay, machines.current_from_flux)
        columns = self._feed.last - self._feed.first
        track = Track(np.empty((n, 2, columns)), np.empty((n, columns)))
        nothing = Comparison(np.empty((0, 2)), 1, np.empty(n))
        play(self._feed, delays, machines, InitialState(flux, np.zeros(n)), nothing, track)
        return Trajectories(track.current[:, :, self._wanted], track.speed[:, self._wanted])

    def require_voltages(self, offsets_s: Array) -> None:
        """Raise an error where an offset reaches beyond the voltages there are.

        Parameters
        ----------
        offsets_s : ndarray, shape (candidates,)
            Delays of the currents against the voltages [s].

        Raises
        ------
        ValueError
            If one does.
        """
        earliest, latest = self.earliest_offset_s, self.latest_offset_s
        if offsets_s.size and not (earliest <= offsets_s.min() and offsets_s.max() <= latest):
            raise ValueError(
                f"time offsets: expected {earliest:g} to {latest:g} s, for which the record has voltages, "
                f"found {offsets_s.min():g} to {offsets_s.max():g} s"
            )


def _circuits(candidates: StartCandidates, share: Array) -> tuple[Array, Array]:
    """Return inductances and resistances (candidates, 5, 5) of symmetrical machines (3.14, 3.15).

    The rotor's rows are multiplied by J_ref / J; the fifth circuit is idle, as in `healthy`.
    """
    L_m = MAGNETISING_OVER_SELF * candidates.stator_self_inductance_H
    L, R = np.zeros((len(candidates), 5, 5)), np.zeros((len(candidates), 5, 5))
    for axis in (0, 1):
        stator, rotor = axis, axis + 2
        L[:, stator, stator] = candidates.stator_leakage_H + L_m
        L[:, stator, rotor] = L_m
        L[:, rotor, stator] = share * L_m
        L[:, rotor, rotor] = share * (candidates.rotor_leakage_H + L_m)
        R[:, stator, stator] = candidates.stator_resistance_ohm
        R[:, rotor, rotor] = share * candidates.rotor_resistance_ohm
    L[:, 4, 4] = candidates.stator_leakage_H
    R[:, 4, 4] = candidates.stator_resistance_ohm
    return L, R
