"""What a start tells of the motor's parameters: commissioning of that one record."""

from core.commissioning.commissioning import commission
from core.machines.motor_file.reader import Plate
from core.machines.parameters import Motor
from core.recordings import Recording
from core.starts.examined import StartParameters

LONGEST_COMPARED_S = 4.0
"""Longest part of a start that is fitted here: the time that it takes grows with it."""


def start_parameters(recording: Recording, motor: Motor) -> StartParameters:
    """Estimate the motor's parameters from one start.

    Parameters
    ----------
    recording : Recording
        A recording in which the motor starts from rest.
    motor : Motor
        The motor; the search is centred on its parameters.

    Returns
    -------
    StartParameters
        The parameters.

    Raises
    ------
    RecordingError
        If the recording lacks channels.
    CommissioningError
        If it is no start from rest that can be used.
    """
    plate = Plate(
        motor.name,
        motor.nameplate,
        None if motor.is_typical else motor.parameters,
        motor.channels,
        motor.limits,
        motor.sensors,
        motor.transformers,
        motor.parameters_source,
        wound_rotor=motor.wound_rotor,
    )
    found = commission([recording], plate, span_s=(0.0, LONGEST_COMPARED_S))
    (start,) = found.starts
    return StartParameters(
        values={name: one.value for name, one in found.parameters.items()},
        ci95={name: one.ci95 for name, one in found.parameters.items() if one.ci95 is not None},
        load_level=start.load_level.value,
        load_level_ci95=start.load_level.ci95,
        load_law=found.load_law,
        residual_share=start.residual_share,
        warnings=found.warnings,
    )
