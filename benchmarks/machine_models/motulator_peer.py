"""The healthy machine from rest in motulator (Helsinki, MIT licence), voltages held over every sample."""

from importlib.util import find_spec
from time import perf_counter

import numpy as np

from core.machines.parameters import Motor


class _Mains:
    """Stands where motulator expects a controller: the duty ratios of a sine-shaped supply."""

    def __init__(self, step_s: float, frequency_hz: float, amplitude: float) -> None:
        self._step_s, self._frequency_hz, self._amplitude = step_s, frequency_hz, amplitude

    def __call__(self, drive: object) -> tuple[float, list[float]]:
        # Of the middle of the step, which begins one step later: motulator delays the duty ratios by one.
        t = float(drive.t0) + 1.5 * self._step_s  # type: ignore[attr-defined]  # motulator has no types
        angles = 2.0 * np.pi * (self._frequency_hz * t - np.arange(3) / 3.0)
        return self._step_s, list(0.5 + self._amplitude * np.cos(angles))

    def post_process(self) -> None:
        """Nothing was recorded here."""


def motulator_seconds(motor: Motor, samples: int, rate_hz: float, load_level: float) -> float | None:
    """Wall time of one simulation of a star-connected motor [s]; None where motulator is not installed."""
    if find_spec("motulator") is None:
        return None
    from motulator.drive import model
    from motulator.drive.utils import InductionMachinePars

    nameplate, p = motor.nameplate, motor.parameters
    # The gamma equivalent circuit of the same machine: all leakage on the rotor's side.
    stator = p.stator_leakage_H + p.magnetising_inductance_H
    ratio = stator / p.magnetising_inductance_H
    machine = model.InductionMachine(
        InductionMachinePars(
            n_p=nameplate.pole_pairs,
            R_s=p.stator_resistance_ohm,
            R_r=ratio**2 * p.rotor_resistance_ohm,
            L_ell=ratio * p.stator_leakage_H + ratio**2 * p.rotor_leakage_H,
            L_s=stator,
        )
    )
    load = load_level * nameplate.rated_torque_Nm
    mechanics = model.StiffMechanicalSystem(J=p.inertia_kgm2, tau_L=lambda t: load + 0.0 * t)
    dc_voltage = 2.0 * nameplate.rated_voltage_V
    amplitude = nameplate.rated_voltage_V * np.sqrt(2.0 / 3.0) / dc_voltage
    drive = model.Drive(model.VoltageSourceConverter(u_dc=dc_voltage), machine, mechanics)
    mains = _Mains(1.0 / rate_hz, nameplate.rated_frequency_Hz, amplitude)
    simulation = model.Simulation(drive, mains)
    begun = perf_counter()
    simulation.simulate(t_stop=(samples - 1) / rate_hz)
    return perf_counter() - begun
