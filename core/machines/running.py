"""Steady running of a batch of candidates on one supply: speed, flux and the currents' fundamental."""

from dataclasses import dataclass

import numpy as np

from core.machines.base import RotorAsymmetry, StatorModel
from core.machines.batch import find_rates, find_steady_states
from core.machines.candidates import Candidates, LoadLaw
from core.machines.parameters import Motor
from core.machines.steady_state import ComplexArray, SinusoidalSupply, SteadyState
from core.machines.stepping import MachineRates


@dataclass(frozen=True, slots=True)
class Rates:
    """What a batch is stepped with.

    Parameters
    ----------
    machines : MachineRates
        Coefficients of the batch.
    rotor_asymmetry : RotorAsymmetry or None
        Part of the rotors' resistance that turns with them, where there is any.
    """

    machines: MachineRates
    rotor_asymmetry: RotorAsymmetry | None


class SteadyRunning:
    """One motor and one model on a sinusoidal supply; any number of candidates.

    Parameters
    ----------
    model : StatorModel
        Machine model.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    angular_frequency : float
        Angular frequency w_s of the supply [rad/s].
    phasor : ndarray of complex, shape (2,)
        Voltage on the Clarke axes at t = 0, peak [V].
    load_law : LoadLaw, default LoadLaw.CONSTANT
        How the load torque grows with speed.
    """

    def __init__(
        self,
        model: StatorModel,
        motor: Motor,
        angular_frequency: float,
        phasor: ComplexArray,
        load_law: LoadLaw = LoadLaw.CONSTANT,
    ) -> None:
        self.model = model
        self.motor = motor
        self.angular_frequency = angular_frequency
        self.phasor = phasor
        self.load_law = load_law
        nameplate, machine = motor.nameplate, motor.parameters
        w_s, w_b = angular_frequency, nameplate.rated_angular_frequency
        self._torque_per_pole_pair = nameplate.rated_torque_Nm / nameplate.pole_pairs / w_b**load_law.value
        self._gain = nameplate.pole_pairs**2 / machine.inertia_kgm2
        # Slip of the healthy machine's greatest torque: R_r' over the impedance of R_s and the leakages.
        leakage = w_s * (machine.stator_leakage_H + machine.rotor_leakage_H)
        impedance = float(np.hypot(machine.stator_resistance_ohm, leakage))
        self._pull_out_slip = min(1.0, machine.rotor_resistance_ohm / impedance)

    def on(self, phasor: ComplexArray) -> "SteadyRunning":
        """Return the same motor on another voltage of the same frequency.

        Parameters
        ----------
        phasor : ndarray of complex, shape (2,)
            Voltage on the Clarke axes at t = 0, peak [V].

        Returns
        -------
        SteadyRunning
            The motor on that voltage.
        """
        return SteadyRunning(self.model, self.motor, self.angular_frequency, phasor, self.load_law)

    def rates(self, candidates: Candidates) -> Rates:
        """Return what the candidates are stepped with.

        Parameters
        ----------
        candidates : Candidates
            The batch of hypotheses.

        Returns
        -------
        Rates
            Coefficients of the batch.
        """
        n = len(candidates)
        circuits = self.model.circuits(self.motor, candidates)
        load = np.zeros((n, 3))
        load[:, int(self.load_law)] = candidates.load_level * self._torque_per_pole_pair
        machines = MachineRates(np.empty((n, 5, 5)), np.empty((n, 5, 5)), load, self._gain)
        find_rates(circuits.inductance, circuits.resistance, machines.decay, machines.current_from_flux)
        return Rates(machines, circuits.rotor_asymmetry)

    def state(self, candidates: Candidates, rates: Rates | None = None) -> SteadyState:
        """Return the periodic steady state of every candidate.

        Parameters
        ----------
        candidates : Candidates
            The batch of hypotheses.
        rates : Rates or None, optional
            What the candidates are stepped with, where it is known already.

        Returns
        -------
        SteadyState
            The steady states.
        """
        known = self.rates(candidates) if rates is None else rates
        n = len(candidates)
        state = SteadyState(
            flux=np.empty((5, n)),
            speed=np.empty(n),
            mean_speed=np.empty(n),
            current=np.empty((2, n), np.complex128),
            balanced=np.empty(n, np.bool_),
        )
        supply = SinusoidalSupply(self.angular_frequency, self.phasor, self._pull_out_slip)
        find_steady_states(known.machines, candidates.time_offset_s, supply, state)
        return state
