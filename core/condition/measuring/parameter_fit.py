"""What a motor's records together tell of errors of the parameters in its file.

The forward-turning current of a motor lies on a circle, whatever its load (`core.machines.current_locus`).
The distance of each record from the circle of the file is linear in small errors: of R_s, the leakages and
L_s, and of what the relay's channels have in common, their gain and the offset between currents and voltages.
Records at different loads tell these apart. The sums of a linear least-squares fit are all that is kept.
"""

from math import sqrt
from typing import Any, Final

import numpy as np

from core.condition.assessment import ParameterError
from core.condition.measuring.measurement import Measurement
from core.diagnosis.priors import SATURATION, TOGETHER
from core.machines.parameters import Motor

UNKNOWNS: Final = 5
"""Offset and gain over their standard deviations, then relative errors of R_s, both leakages and L_s."""
PARAMETER_FIT: Final = np.dtype(
    [
        ("information", "f8", (UNKNOWNS, UNKNOWNS)),
        ("vector", "f8", (UNKNOWNS,)),
        ("records", "f8"),
        ("voltage", "f8"),
    ]
)
"""Sums over the records: information matrix and vector, their number, and relative errors of the voltage."""

TINY: Final = 1e-12
FEWEST: Final = 6
"""Records before anything is told."""
ALL_OF: Final = 24
EVERY: Final = 32
"""The first records all count; then one of so many, which is as good and costs little."""
DEVIATION: Final = 0.004
"""Standard deviation of the distance from the circle that no parameter explains, a share of the current."""
PERSISTENT: Final = 20.0
"""Errors of the model do not average out: more records than this tell no more."""
WIDE: Final = 0.5
"""Standard deviation of a parameter's error before the first record."""
SURE: Final = 2.2
"""Standard deviations by which an error lies beyond its tolerance where it is told."""
IN_WORDS: Final = ("R_s", "leakage", "L_s")
TOLERANCES: Final = ("stator_resistance_ohm", "stator_leakage_H", "stator_self_inductance_H")


def counts(records: float) -> bool:
    """Tell whether the next record is taken into the fit.

    Parameters
    ----------
    records : float
        Number of the record in its reference, from 0.

    Returns
    -------
    bool
        Whether it is.
    """
    return records < ALL_OF or records % EVERY == 0.0


def add_record(fit: Any, record: Measurement) -> None:
    """Add a record to the sums.

    Parameters
    ----------
    fit : record of PARAMETER_FIT
        The sums; they change.
    record : Measurement
        The record.
    """
    seen, size = record.circle, abs(record.j1)
    if seen.outwards == 0.0:
        return
    row = np.array(seen.slopes[:UNKNOWNS]) / size
    by_voltage = abs(seen.slopes[UNKNOWNS]) / size
    variance = DEVIATION**2 + (SATURATION * by_voltage) ** 2
    fit["information"] += np.outer(row, row) / variance
    fit["vector"] += row * (seen.distance / size / variance)
    fit["records"] += 1.0
    fit["voltage"] += by_voltage / max(abs(row[UNKNOWNS - 1]), TINY)


def parameter_errors(fit: Any, motor: Motor) -> tuple[ParameterError, ...]:
    """Return the parameters that the records contradict.

    Parameters
    ----------
    fit : record of PARAMETER_FIT
        The sums.
    motor : Motor
        The motor, with the tolerances of its parameters.

    Returns
    -------
    tuple of ParameterError
        Those surely beyond their tolerances; nothing is told of a motor with typical parameters.
    """
    records = float(fit["records"])
    if records < FEWEST or motor.is_typical:
        return ()
    share = 1.0 / max(1.0, records / PERSISTENT)
    prior = np.diag([1.0, 1.0, *[WIDE**-2.0] * len(IN_WORDS)])
    spread = np.linalg.inv(share * fit["information"] + prior)
    found = spread @ (share * fit["vector"])
    tolerances = [TOGETHER * getattr(motor.tolerances, name) for name in TOLERANCES]
    tolerances[2] += SATURATION * float(fit["voltage"]) / records
    told = []
    for k, (name, tolerance) in enumerate(zip(IN_WORDS, tolerances, strict=True), start=2):
        error, deviation = float(found[k]), sqrt(float(spread[k, k]))
        if abs(error) > tolerance + SURE * deviation:
            told.append(ParameterError(name, error, deviation))
    return tuple(told)
