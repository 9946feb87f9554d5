"""Signature indicators, computed from currents and voltages without a model, to compare with the fit."""

from math import degrees, pi

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.verdict import Indicators
from core.machines.parameters import Connection
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import PhaseSequence, sequence_phasors


def indicators(case: Case) -> Indicators:
    """Compute the model-free indicators over the whole record [1]_.

    References
    ----------
    .. [1] Cardoso, Cruz, Fonseca, IEEE Trans. Energy Convers. 14(3), 1999.
    """
    rate, frequency = case.sample_rate_hz, case.frequency_hz
    current = sequence_phasors(fundamental_phasors(case.current_ab, frequency, rate))
    V_alpha, V_beta = case.supply.phasor / np.sqrt(2.0)
    voltage = sequence_phasors(np.array([V_alpha, V_beta]))
    line = case.line_per_winding_current
    forward, backward = abs(current.positive), abs(current.negative)
    # i = I1 e^{jwt} + conj(I2) e^{-jwt}: the major axis lies where both point the same way.
    major = (np.angle(current.positive) - np.angle(current.negative)) / 2.0
    if case.motor.nameplate.connection is Connection.DELTA:
        major -= pi / 6.0
    if case.sequence is PhaseSequence.ACB:
        major = -major
    return Indicators(
        current_unbalance=backward / forward,
        voltage_unbalance=abs(voltage.negative) / abs(voltage.positive),
        negative_sequence_current_A=backward * line,
        negative_sequence_impedance_ohm=abs(voltage.negative) / max(backward, 1e-12) / line**2,
        park_axis_ratio=abs(forward - backward) / (forward + backward),
        park_axis_angle_deg=degrees((major + pi / 2.0) % pi - pi / 2.0),
    )
