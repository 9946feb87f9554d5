"""What a motor's records together tell of errors of the parameters in its file.

The forward-turning current of a motor lies on a circle, whatever its load (`core.machines.current_locus`).
The distance of each record from the circle of the file is linear in small errors: of R_s, the leakages and
L_s, and of what the relay's channels have in common, their gain and the offset between currents and voltages.
Records at different loads tell these apart. The sums of a linear least-squares fit are all that is kept.
"""

from math import pi, sqrt
from typing import Any, Final

import numpy as np

from core.condition.assessment import ParameterError
from core.condition.observation import Observation
from core.diagnosis.parameter_check import (
    SATURATION,
    TOGETHER,
    gain_deviation,
    offset_deviation_s,
    slopes_of_parameters,
    slopes_of_sensors,
)
from core.machines.current_locus import current_locus
from core.machines.parameters import Connection, Motor

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


def add_record(fit: Any, observation: Observation, motor: Motor) -> None:
    """Add a record to the sums.

    Parameters
    ----------
    fit : record of PARAMETER_FIT
        The sums; they change.
    observation : Observation
        The record.
    motor : Motor
        The motor.
    """
    plate, machine = motor.nameplate, motor.parameters
    w = 2.0 * pi * observation.frequency_hz
    admittance = observation.positive_current_A / observation.positive_voltage_V
    locus = current_locus(machine, w)
    distance = locus.distance(admittance) / abs(admittance)
    gain, offset = slopes_of_sensors(locus, admittance, w)
    sensors = (offset * offset_deviation_s(motor.sensors), gain * gain_deviation(motor.sensors))
    parameters = -slopes_of_parameters(machine, locus, admittance, w)
    row = np.array([*sensors, *parameters])
    per_line = sqrt(2.0) if plate.connection is Connection.DELTA else sqrt(2.0 / 3.0)
    flux = plate.rated_frequency_Hz / observation.frequency_hz
    voltage = abs(abs(observation.positive_voltage_V) * flux / (per_line * plate.rated_voltage_V) - 1.0)
    variance = DEVIATION**2 + (SATURATION * voltage * parameters[2]) ** 2
    fit["information"] += np.outer(row, row) / variance
    fit["vector"] += row * (distance / variance)
    fit["records"] += 1.0
    fit["voltage"] += voltage


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
