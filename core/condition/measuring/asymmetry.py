"""The asymmetry of a motor in one record, told as the shorted turns that would look the same."""

from core.condition.measuring.impedance import negative_impedance
from core.condition.measuring.measurement import measure
from core.condition.measuring.turns_grid import turns_grid
from core.condition.observation import Observation
from core.diagnosis.channel_errors import A
from core.machines.parameters import Motor
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence


def asymmetry_of(observation: Observation, motor: Motor) -> complex:
    """Return the asymmetry of one record in the plane of the phases.

    Shorted turns of phase a point along 1, of phase b along a = exp(j 120 deg), of phase c along a^2, on the
    average of what their axis and leakage may be: one coil's may lie 40 degrees beside it. The length is the
    level. An error of a sensor or of the motor's parameters points anywhere. It is what this record shows by
    itself; a condition is judged from many.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.
    motor : Motor
        The motor.

    Returns
    -------
    complex
        Equivalent level and direction, a fraction of the phase turns.

    Raises
    ------
    ObservationError
        If a number is missing, infinite or impossible, or the motor was not running on three phases.
    """
    scale_ohm = abs(negative_impedance(motor, motor.nameplate.rated_frequency_Hz))
    y = measure(observation, motor, scale_ohm, 0.0).y
    level = y / turns_grid(motor, PhaseSequence.ABC, scale_ohm).mean
    if observation.sequence is PhaseSequence.ACB:
        # The winding frame is mirrored: its first winding stays an axis, the two others change places.
        return level.conjugate() * A ** terminal_winding(0, observation.sequence, motor.nameplate.connection)
    return level
