"""What the leakage of a broken cage adds to its asymmetry: the factor c of core.rotor.cage_leakage."""

from concurrent.futures import Executor
from itertools import product
from math import log10, pi

import numpy as np

from benchmarks.reporting import Section, table
from core.machines.parameters import Motor
from core.rotor.cage_leakage import MOST, USUAL
from ied_sim.motor.cage import Cage, cage_loops
from testing.machines.motors import ALL, VERY_LARGE

MOTORS = (*ALL, VERY_LARGE)
RATED_SLIPS = (0.05, 0.035, 0.012, 0.008)
BARS, RING_SHARES = (28, 36, 44, 56), (0.1, 0.25, 0.5)
BROKEN, LOADS = (1, 2, 3, 4), (0.25, 0.5, 1.0, 1.2)


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The table by broken bars and load."""
    del pool, quick
    rows = []
    for broken, load in product(BROKEN, LOADS):
        found = np.array(
            [
                _of_cage(motor, Cage(bars, ring), broken / bars, load * slip)
                for (motor, slip), bars, ring in product(
                    zip(MOTORS, RATED_SLIPS, strict=True), BARS, RING_SHARES
                )
                if Cage(bars, ring).spread_leakage(motor.parameters, motor.nameplate.pole_pairs)
                < motor.parameters.rotor_leakage_H
            ]
        )
        factor, rise_dB = found.T
        middle = f"{np.median(factor):.2f} ({factor.min():.2f} to {factor.max():.2f})"
        rows.append([str(broken), f"{load:.0%}", middle, f"{rise_dB.min():.1f} to {rise_dB.max():.1f} dB"])
    intro = (
        "The impedance of the axes of cages at the slip frequency beside their resistance, by the network of "
        f"bars and rings: the factor c (middle, least and greatest; {USUAL:g} is taken, and up to {MOST:g} "
        "within the interval), and by how much the severity would read high without it."
    )
    lines = (intro, "", *table(["bars broken", "load", "c", "would read high by"], rows))
    return [Section("leakage", "Leakage", "python -m benchmarks.rotor --subject leakage", lines)]


def _of_cage(motor: Motor, cage: Cage, broken_share: float, slip: float) -> tuple[float, float]:
    """Return the factor c, and by how much the impedance's asymmetry exceeds the resistance's [dB]."""
    machine = motor.parameters
    loops = cage_loops(machine, motor.nameplate.pole_pairs, cage, broken_share)
    w = 2.0 * pi * slip * motor.nameplate.rated_frequency_Hz
    conductance = loops.axes @ np.linalg.solve(loops.resistance, loops.axes.T)
    (low, high), across = np.linalg.eigh(conductance)
    inductance = loops.leakage + loops.gap
    admittance = loops.axes @ np.linalg.solve(loops.resistance + 1j * w * inductance, loops.axes.T)
    first, second = np.diag(across.T @ np.linalg.inv(admittance) @ across)
    resistance = (first + second).real / 2.0
    measured, true = abs(first - second) / 2.0 / resistance, (high - low) / (high + low)
    reactance = w / resistance * machine.magnetising_inductance_H
    return (measured / true - 1.0) / (measured * reactance), 20.0 * log10(measured / true)
