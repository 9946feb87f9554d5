"""Examines a recorded start: its figures, and what the motor's model tells of it."""

from dataclasses import replace
from math import pi

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.commissioning.stepped_start import SteppedStart, stepped_start
from core.machines.air_gap import AirGap
from core.machines.parameters import Motor, ParametersSource
from core.recordings import Recording, RecordingError
from core.rotor.starts import start_sideband
from core.starts.examined import ExaminedStart, StartParameters
from core.starts.figures import MotorStart
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
        return _with_model(recording, motor, figures)
    except (RecordingError, CommissioningError) as error:
        reason = f"{error.field}: expected {error.expected}, found {error.found}"
    except (ValueError, ArithmeticError) as error:  # numpy's LinAlgError is among them
        reason = f"the model's figures cannot be computed: {error}"
    return ExaminedStart(figures, stress=start_stress(figures, motor), remark=reason)


def _with_model(recording: Recording, motor: Motor, figures: MotorStart) -> ExaminedStart:
    """Return a start with what the model tells. Raises RecordingError, CommissioningError, and of figures.

    The errors of figures are ValueError and ArithmeticError.
    """
    start = start_of(
        recording,
        motor.nameplate,
        motor.channels,
        transformers=motor.transformers,
        by_steps=motor.wound_rotor is not None,
    )
    gap = start.air_gap(motor.parameters)
    stepped = None if motor.wound_rotor is None else stepped_start(gap, motor)
    if stepped is not None:
        return _by_steps(figures, gap, motor, stepped)
    found = start_parameters(recording, motor)
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


def _by_steps(figures: MotorStart, gap: AirGap, motor: Motor, found: SteppedStart) -> ExaminedStart:
    """Return a start by steps of a wound rotor's resistance: its speed is that of the equation of motion."""
    known = replace(motor, parameters=replace(motor.parameters, inertia_kgm2=found.inertia_kgm2))
    speed = found.speed / (2.0 * pi * gap.frequency_hz)
    torque = start_torque(replace(gap, slip=1.0 - speed), known, figures.acceleration_s)
    steps = f"{len(found.begins_s) - 1} steps of the resistance at the slip rings"
    return ExaminedStart(
        figures,
        torque,
        stress=start_stress(figures, motor),
        remark=f"a start by {steps}: it tells inertia and load ({found.inertia_kgm2:.3g} kg m^2, "
        f"{found.load_torque_Nm:.3g} N m), no impedances, and nothing of an uneven rotor",
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
