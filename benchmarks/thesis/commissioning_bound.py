"""The Cramer-Rao bound of a start: how well any unbiased estimator could tell the parameters.

From derivatives of the simulator's own currents, by central differences; seven unknowns (R_s, R_r', both
leakages as one, L_s, J, LL, T_d) and white noise on the currents.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from core.signals.clarke import clarke
from testing.machines.starts import StartRecord, with_parameters

STEP = 1e-4


def bound(motor: Motor, record: StartRecord) -> NDArray[np.float64]:
    """Least standard deviations of R_s, R_r', L_ls, L_s, J, relative, (5,).

    record: snr_db is that of the record whose bound is asked for; its noise is left out here.
    """
    snr_db = record.snr_db
    if snr_db is None:
        raise ValueError("a bound needs a level of noise: the record has no snr_db")
    clean = replace(record, snr_db=None, voltage_snr_db=None, time_offset_s=0.0)

    def current(factors: dict[str, float], load: float) -> NDArray[np.float64]:
        machine = motor.parameters
        moved = with_parameters(motor, **{name: getattr(machine, name) * f for name, f in factors.items()})
        return clarke(replace(clean, load_level=load).of(moved).samples[:3])

    columns = []
    for names in (
        ("stator_resistance_ohm",),
        ("rotor_resistance_ohm",),
        ("stator_leakage_H", "rotor_leakage_H"),
        ("stator_self_inductance_H",),
        ("inertia_kgm2",),
    ):
        up = current(dict.fromkeys(names, 1.0 + STEP), record.load_level)
        down = current(dict.fromkeys(names, 1.0 - STEP), record.load_level)
        columns.append((up - down) / (2.0 * STEP))
    columns.append(
        (current({}, record.load_level + STEP) - current({}, record.load_level - STEP)) / (2.0 * STEP)
    )
    true = current({}, record.load_level)
    columns.append(np.gradient(true, axis=1))
    jacobian = np.stack([column.reshape(-1) for column in columns], axis=1)
    rms = float(np.sqrt(np.mean(clean.of(motor).samples[:3] ** 2)))
    sigma = rms * 10.0 ** (-snr_db / 20.0)
    covariance = sigma**2 * np.linalg.inv(jacobian.T @ jacobian)
    return np.asarray(np.sqrt(np.diag(covariance))[:5])
