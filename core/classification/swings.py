"""Evidence of what swings: the air gap's permeance, and the load's torque."""

from math import log
from typing import Final

from core.classification.amplitude import log_ratio, ratio
from core.classification.evidence import Block, log_sum, only
from core.diagnosis.causes import Cause
from core.normal_distribution import NORMAL_95
from core.rotor.finding import LOAD_OSCILLATION, RotorFinding, RotorState
from core.rotor.swing_findings import EVEN_GAP, STEADY_LOAD, EccentricityFinding, PulsationFinding

UNEVEN_GAPS = (0.03, 0.1)
"""Ripple of the permeance of motors to be looked after."""
SWINGING_LOADS = (0.03, 0.1)
"""Swing of the torque of loads that pulsate, over the rated one, rms."""
TORQUE_NOISE: Final = 0.002
"""Noise of the torque at twice the slip, rms, over rated torque; the rotor's finding does not tell it."""


def eccentricity_block(finding: EccentricityFinding) -> Block | None:
    """Return the evidence of the air gap's permeance."""
    value, deviation = finding.permeance_ripple, finding.standard_deviation
    if value is None or deviation is None:
        return None
    return only(
        Cause.ECCENTRICITY,
        log_ratio(value, deviation, EVEN_GAP, UNEVEN_GAPS),
        f"the air gap's permeance ripples by {value:.1%} once a turn (+-{NORMAL_95 * deviation:.1%})",
    )


def pulsation_block(
    rotor: RotorFinding, eccentricity: EccentricityFinding, pulsation: PulsationFinding
) -> Block | None:
    """Return the evidence of swings of the load: at twice the slip, once a turn, or elsewhere."""
    swings: list[tuple[float, float, str]] = []
    # The rotor's own rule tells a swing of the load from an inertia that is wrong.
    is_of_load = any(reason.startswith(f"{LOAD_OSCILLATION}:") for reason in rotor.reasons)
    if rotor.load_oscillation_dB is not None and (is_of_load or rotor.state is not RotorState.UNSUPPORTED):
        swing = ratio(rotor.load_oscillation_dB) if is_of_load else 0.0
        swings.append((swing, TORQUE_NOISE, "at twice the slip"))
    if eccentricity.load_torque is not None and eccentricity.load_torque_deviation is not None:
        swings.append((eccentricity.load_torque, eccentricity.load_torque_deviation, "once a turn"))
    if pulsation.load_torque is not None and pulsation.noise is not None:
        where = f"at {pulsation.frequency_hz:.2f} Hz"
        swings.append((pulsation.load_torque, pulsation.noise, where))
    if not swings:
        return None
    ratios = [log_ratio(swing, noise, STEADY_LOAD, SWINGING_LOADS) for swing, noise, _ in swings]
    swing, _, where = swings[ratios.index(max(ratios))]
    return only(
        Cause.PULSATION,
        log_sum(ratios) - log(len(ratios)),
        f"the load's torque swings by {swing:.1%} of the rated one {where}",
    )
