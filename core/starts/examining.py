"""Examines a recorded start: its figures, and what the motor's model tells of it."""

from dataclasses import replace

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.machines.parameters import Motor, ParametersSource
from core.recordings import Recording, RecordingError
from core.rotor.starts import start_sideband
from core.starts.examined import ExaminedStart, StartParameters
from core.starts.measuring import measure_start
from core.starts.parameters import start_parameters
from core.starts.stress import start_stress
from core.starts.torque import start_torque

USUAL_RESIDUAL = 0.1
"""Share of the current that a model may leave and still be taken for the motor."""


def examine_start(recording: Recording, motor: Motor) -> ExaminedStart:
    """Examine a start.

    Parameters
    ----------
    recording : Recording
        A recording in which the motor starts.
    motor : Motor
        Nameplate, parameters, channel names and ratios of the motor.

    Returns
    -------
    ExaminedStart
        What it shows. Where the model cannot help, `remark` says why.

    Raises
    ------
    RecordingError
        If nothing at all can be measured.
    """
    figures = measure_start(recording, motor)
    try:
        start = start_of(recording, motor.nameplate, motor.channels, transformers=motor.transformers)
        found = start_parameters(recording, motor)
    except (RecordingError, CommissioningError) as error:
        reason = f"{error.field}: expected {error.expected}, found {error.found}"
        return ExaminedStart(figures, stress=start_stress(figures, motor), remark=reason)
    fits = found.residual_share <= USUAL_RESIDUAL
    known = _with_parameters(motor, found) if fits else motor
    gap = start.air_gap(known.parameters)
    run_up_s = figures.acceleration_s or figures.i2t_over_s
    return ExaminedStart(
        figures,
        start_torque(gap, known, figures.acceleration_s),
        found if fits else None,
        start_sideband(gap, known.parameters, run_up_s),
        start_stress(figures, known),
        None
        if fits
        else f"the model leaves {found.residual_share:.0%} of the current unexplained: the motor file's "
        "parameters were used",
    )


def _with_parameters(motor: Motor, found: StartParameters) -> Motor:
    """Return the motor with what this start tells of it.

    The inertia is the motor file's where that has one: it is the same in all starts, and one start alone may
    take it for load.
    """
    machine = found.machine
    if motor.is_typical:
        return replace(motor, parameters=machine, parameters_source=ParametersSource.COMMISSIONED)
    return replace(motor, parameters=replace(machine, inertia_kgm2=motor.parameters.inertia_kgm2))
