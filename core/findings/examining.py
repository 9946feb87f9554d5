"""Examine a record once for all that it tells of its motor."""

from dataclasses import replace
from time import perf_counter

from core.classification.record import classify_record
from core.condition.measuring.observing import observation_of
from core.diagnosis.acceptance import accept
from core.diagnosis.baseline import Baseline
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.stator import diagnose_accepted
from core.findings.beside_stator import (
    losses_of,
    rotor_and_swings_of,
    speed_beside,
    supply_of,
)
from core.findings.findings import Findings
from core.machines.parameters import Motor
from core.numerical_threads import on_one_thread
from core.recordings import Recording
from core.speed.memory import LineMemory


@on_one_thread
def examine(
    recording: Recording,
    motor: Motor,
    *,
    method: str = DEFAULT_METHOD,
    model: str = DEFAULT_MODEL,
    baseline: Baseline | None = None,
    currents_only: bool = False,
    lines: LineMemory | None = None,
) -> Findings:
    """Diagnose a record, observe the motor's condition in it, and see what it tells beside its stator.

    The record goes through the quality gate once for all. A baseline serves the diagnosis alone: the
    observation holds what was measured.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        Nameplate, parameters, channel names, limits and sensors of the motor.
    method : str, optional
        Global search, one of `core.diagnosis.methods.Method`.
    model : str, optional
        Fault model, one of `core.diagnosis.methods.Model`.
    baseline : Baseline or None, optional
        The motor's standing asymmetry, for the diagnosis.
    currents_only : bool, default False
        Use no voltages, recorded or not; there is no observation then.
    lines : LineMemory or None, optional
        What earlier records told of the lines of the motor's rotor, for its speed; it learns from this one.

    Returns
    -------
    Findings
        All that the record tells, without what a start shows.

    Raises
    ------
    RecordingError
        If the recording lacks channels that the motor needs.
    DiagnosisError
        If the method or the model is unknown.
    """
    begun = perf_counter()
    acceptance = accept(recording, motor, currents_only=currents_only)
    diagnosis = diagnose_accepted(acceptance, method=method, model=model, baseline=baseline, begun=begun)
    accepted, undated = acceptance.accepted, recording.start_time_ns is None
    supply, problem = supply_of(recording, motor, acceptance)
    if problem is not None:
        diagnosis = replace(diagnosis, reasons=(*diagnosis.reasons, problem))
    speed = speed_beside(accepted, diagnosis, lines)
    rotor, eccentricity, pulsation = rotor_and_swings_of(recording, accepted, diagnosis, speed)
    trigger = recording.trigger_index
    return Findings(
        diagnosis=diagnosis,
        rotor=rotor,
        eccentricity=eccentricity,
        pulsation=pulsation,
        speed=speed,
        classification=classify_record(diagnosis, rotor, eccentricity, pulsation),
        losses=losses_of(motor, diagnosis, supply, rotor, speed),
        supply=supply,
        observation=None if accepted is None or undated else observation_of(recording, accepted),
        duration_s=recording.duration_s,
        pre_trigger_s=None if trigger is None else float(recording.time_s[trigger]),
    )
