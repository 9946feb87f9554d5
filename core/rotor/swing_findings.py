"""What a record tells of the air gap, and of a load that swings; what finds it is beside this module."""

from dataclasses import dataclass

from core.reasoned_figures import ReasonedFigures

EVEN_GAP = 0.004
"""Ripple of the permeance of a sound motor, a tenth of static times a twentieth of dynamic eccentricity."""
STEADY_LOAD = 0.004
"""Swing of a steady load's torque over the rated one, rms."""
NOISE_RMS = 4.0
"""Noise alone passes so many times its rms in one of ten thousand records of a thousand frequencies."""


@dataclass(frozen=True, slots=True)
class EccentricityFinding(ReasonedFigures):
    """What a record tells of the air gap; figures are None where it cannot tell them.

    Parameters
    ----------
    permeance_ripple : float or None
        Amplitude of the relative ripple of the gap's permeance, once a turn.
    standard_deviation : float or None
        Its standard deviation: noise, and the parameters of the model.
    detection_limit : float or None
        Ripple that nine of ten such records show.
    lower_sideband_dB, upper_sideband_dB : float or None
        Current at f - f_r and f + f_r as measured, over the fundamental [dB].
    load_torque : float or None
        Torque of the load that swings once a turn, its amplitude over rated torque.
    load_torque_deviation : float or None
        Its standard deviation, over rated torque.
    rotation_frequency_hz : float or None
        Frequency f_r at which the lines stand [Hz].
    reasons : tuple of str
        What limits the figures, in words.
    """

    permeance_ripple: float | None
    standard_deviation: float | None
    detection_limit: float | None
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    load_torque: float | None
    load_torque_deviation: float | None
    rotation_frequency_hz: float | None


@dataclass(frozen=True, slots=True)
class PulsationFinding(ReasonedFigures):
    """The strongest swing of the load's torque; figures are None where a record cannot tell them.

    Parameters
    ----------
    load_torque : float or None
        Its amplitude over rated torque.
    noise : float or None
        What noise makes of it, rms, over rated torque.
    frequency_hz : float or None
        Its frequency [Hz].
    load_torque_deviation : float or None
        Standard deviation of the amplitude: noise, and the parameters of the model; the inertia is taken as
        the motor's file has it.
    detection_limit : float or None
        Swing that nine of ten such records show, over rated torque.
    reasons : tuple of str
        What limits the figures, in words.
    """

    load_torque: float | None
    noise: float | None
    frequency_hz: float | None
    load_torque_deviation: float | None
    detection_limit: float | None
