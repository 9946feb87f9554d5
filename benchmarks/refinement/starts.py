"""The commissioning's refinement beside scipy.optimize.least_squares, on whole starts at the full rate."""

from collections.abc import Iterator
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from core.commissioning.fit import CONVERGED, Records
from core.commissioning.prior import prior_of
from core.commissioning.start_detection import start_of
from core.commissioning.unknowns import Point
from core.machines.candidates import LoadLaw
from core.machines.parameters import ChannelNames, MachineParameters, Motor
from testing.machines.motors import ALL
from testing.machines.starts import StartRecord

Array = NDArray[np.float64]

STARTS = 6
DETUNED = 0.25
"""Standard deviation of the logarithm by which the parameters are off where a fit begins."""


def measure() -> Iterator[str]:
    """Lines of figures, ours beside scipy's in one run."""
    random = np.random.default_rng(5)
    rows = []
    for number in range(STARTS):
        motor = ALL[number % len(ALL)]
        records = _records(motor, float(random.uniform(0.2, 0.8)), number)
        begin = _begin(records, motor, random)
        rows.append((*_ours(records, begin), *_scipys(records, begin)))
        ours, theirs = rows[-1][:3], rows[-1][3:]
        yield (
            f"{motor.name:10s} rms left: ours {ours[0]:.6f} A, scipy's {theirs[0]:.6f} A; simulations "
            f"{ours[1]:.0f}, {theirs[1]:.0f}; {ours[2]:.2f} s, {theirs[2]:.2f} s"
        )
    total = np.array(rows).sum(axis=0)
    yield f"all: ours {total[2]:.2f} s, scipy's {total[5]:.2f} s"


def _records(motor: Motor, load: float, seed: int) -> Records:
    record = StartRecord(load_level=load, snr_db=40.0, busbar=False, seed=seed).of(motor)
    start = start_of(record, motor.nameplate, ChannelNames())
    return Records([start], prior_of(motor.nameplate, motor.parameters), LoadLaw.CONSTANT)


def _begin(records: Records, motor: Motor, random: np.random.Generator) -> Array:
    factors = np.exp(DETUNED * random.standard_normal(5))
    machine = motor.parameters
    off = MachineParameters(
        machine.stator_resistance_ohm * factors[0],
        machine.rotor_resistance_ohm * factors[1],
        machine.stator_leakage_H * factors[2],
        machine.rotor_leakage_H * factors[2],
        machine.stator_self_inductance_H * factors[3],
        machine.inertia_kgm2 * factors[4],
    )
    return records.coordinates.vector(Point(off, np.array([[0.5, 0.0, 0.0, 0.0]])))


def _ours(records: Records, begin: Array) -> tuple[float, float, float]:
    """Rms of the residual, simulations and seconds."""
    before, begun = records.evaluations, perf_counter()
    fit = records.fit(begin, np.ones(begin.size, dtype=np.bool_))
    taken = perf_counter() - begun
    return _rms(fit.residuals[0]), records.evaluations - before, taken


def _scipys(records: Records, begin: Array) -> tuple[float, float, float]:
    lower, upper = records.coordinates.bounds()
    free, nothing = np.ones(begin.size, dtype=np.bool_), np.zeros(begin.size, dtype=np.bool_)
    before, begun = records.evaluations, perf_counter()

    def residual(x: Array) -> Array:
        return -records.linearise(x, nothing)[0][0].reshape(-1)

    def jacobian(x: Array) -> Array:
        return records.linearise(x, free)[1][0].reshape(begin.size, -1).T

    found = least_squares(
        residual,
        begin,
        jacobian,
        bounds=(lower, upper),
        x_scale="jac",
        ftol=CONVERGED,
        xtol=1e-10,
        gtol=1e-12,
    )
    taken = perf_counter() - begun
    return _rms(np.asarray(found.fun)), records.evaluations - before, taken


def _rms(residual: Array) -> float:
    return float(np.sqrt(np.mean(residual**2)))
