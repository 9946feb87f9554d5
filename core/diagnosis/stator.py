"""Diagnosis of one recording: quality gate, evidence over all hypotheses, verdict."""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from math import atan2
from time import perf_counter
from typing import Final

import numpy as np

from core.diagnosis.acceptance import Acceptance, Accepted, accept, not_computable
from core.diagnosis.arrangement_words import connected, level_ci95, with_arrangement
from core.diagnosis.arrangements import arrange
from core.diagnosis.baseline import Baseline, baseline_of, standing
from core.diagnosis.case import Case
from core.diagnosis.causes import Cause
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.estimates import Estimates, estimates_of, nearest_turns
from core.diagnosis.fundamental import fundamental_of
from core.diagnosis.indicators import indicators
from core.diagnosis.judgement import (
    hypotheses_of,
    identified,
    judge,
    names_phase,
    phase_probabilities,
    with_load,
)
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL, Method, Model, resolved
from core.diagnosis.record_errors import Known
from core.diagnosis.record_figures import RecordFigures, figures_of
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET, Fit
from core.diagnosis.residual import residual_rms_A
from core.diagnosis.search import METHODS
from core.diagnosis.stator_evidence import StatorEvidence, weigh_stator
from core.diagnosis.thesis_models import searched
from core.diagnosis.verdict import Diagnosis, FittedParameters, Verdict, not_finite
from core.machines.candidates import Candidates
from core.machines.parameters import Motor
from core.machines.playback import Playback, electrical_to_rpm
from core.machines.stator_models import MODELS
from core.machines.wound_rotor import resistance_ratios
from core.numerical_threads import on_one_thread
from core.quality.assumed_supply import SUPPLY_UNBALANCE
from core.quality.finding import QualityFinding, all_passed
from core.quality.scale import current_scale_advice
from core.recordings import Recording

SPEED_UNKNOWN: Final = (
    "the resistance at the slip rings is not known: the stator and the load are told all the same, slip and "
    "speed are not"
)


@on_one_thread
def diagnose(
    recording: Recording,
    motor: Motor,
    *,
    method: str = DEFAULT_METHOD,
    model: str = DEFAULT_MODEL,
    baseline: Baseline | None = None,
    currents_only: bool = False,
) -> Diagnosis:
    """Diagnose the stator winding from one recording in steady running.

    Whatever else a recording can be guilty of makes it undiagnosable, with the reason.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    method : str, optional
        One of `core.diagnosis.methods.Method`. A global search is the thesis's way: it takes one of its
        models, and such a model takes a search (`core.diagnosis.methods.resolved`).
    model : str, optional
        Fault model, one of `core.diagnosis.methods.Model`; mu_f is its equivalent level.
    baseline : Baseline or None, optional
        The motor's standing asymmetry (`learn_baseline`), taken off the currents first.
    currents_only : bool, default False
        Use no voltages, recorded or not; a balanced supply is assumed, and a fault is called "watch" at most.

    Returns
    -------
    Diagnosis
        Verdict, figures and reasons.

    Raises
    ------
    RecordingError
        If the recording lacks channels that the motor needs.
    DiagnosisError
        If the method or the model is unknown.
    """
    begun = perf_counter()
    _check_known(method, model)
    acceptance = accept(recording, motor, currents_only=currents_only)
    return diagnose_accepted(acceptance, method=method, model=model, baseline=baseline, begun=begun)


def diagnose_accepted(
    acceptance: Acceptance,
    *,
    method: str = DEFAULT_METHOD,
    model: str = DEFAULT_MODEL,
    baseline: Baseline | None = None,
    begun: float | None = None,
) -> Diagnosis:
    """Diagnose the stator winding from a record that has been through the quality gate.

    Parameters
    ----------
    acceptance : Acceptance
        What `accept` says of the record.
    method : str, optional
        One of `core.diagnosis.methods.Method`.
    model : str, optional
        Fault model, one of `core.diagnosis.methods.Model`.
    baseline : Baseline or None, optional
        The motor's standing asymmetry, taken off the currents first.
    begun : float or None, optional
        Time of `time.perf_counter` from which `compute_seconds` counts; now if None [s].

    Returns
    -------
    Diagnosis
        Verdict, figures and reasons.

    Raises
    ------
    DiagnosisError
        If the method or the model is unknown.
    """
    begun = perf_counter() if begun is None else begun
    _check_known(method, model)
    method, model = resolved(method, model)
    try:
        result = replace(
            _diagnosed(acceptance, method, model, baseline, begun), operation=acceptance.operation
        )
        impossible = not_finite(result.as_dict())
    except (np.linalg.LinAlgError, ArithmeticError) as error:
        impossible = str(error)
    if impossible is None:
        return result
    refusal = not_computable(impossible)
    seconds = perf_counter() - begun
    return _refused([refusal], seconds, model, method, currents_only=acceptance.voltages_assumed)


def _diagnosed(
    acceptance: Acceptance, method: str, model: str, baseline: Baseline | None, begun: float
) -> Diagnosis:
    """Diagnose; figures may not be finite. Raises numpy.linalg.LinAlgError, ArithmeticError."""
    quality, assumed, accepted = list(acceptance.quality), acceptance.voltages_assumed, acceptance.accepted
    if accepted is None:
        return _refused(quality, perf_counter() - begun, model, method, currents_only=assumed)
    case = accepted.case if baseline is None else baseline.taken_off(accepted.case)
    figures = _figures(accepted, baseline)
    known = _known(figures, baseline, SUPPLY_UNBALANCE if assumed else 0.0)
    arranged = arrange(figures, case.motor, known, model)
    evidence = arranged.evidence
    estimates = estimates_of(evidence)
    advice = partial(current_scale_advice, accepted.terminals, case.motor)
    quality += [connected(arranged), identified(evidence, advice)]
    if not all_passed(quality):
        return _refused(quality, perf_counter() - begun, model, method, currents_only=assumed)
    evaluations = evidence.evaluations
    fit = _fitted(case, evidence, estimates)
    level, theta_f = estimates.level, fit.theta_f
    if model != Model.COIL:
        found = searched(case, fundamental_of(case), MODELS[model], method)
        evaluations += found.evaluations
        fit = _refined(case, found.best)
        level, theta_f = max(0.0, fit.mu_f), fit.theta_f
    verdict, reasons = judge(case, evidence, estimates, advice)
    verdict, reasons = with_load(verdict, reasons, estimates.load_ci95, advice)
    verdict, reasons = with_arrangement(verdict, reasons, arranged, advice)
    if baseline is not None:
        reasons.append(baseline.reason)
    if resistance_ratios(case.motor).are_open:
        reasons.append(SPEED_UNKNOWN)
    named = (
        verdict is not Verdict.HEALTHY
        and evidence.answer is Cause.SHORTED_TURNS
        and names_phase(evidence, case)
    )
    playback = Playback(MODELS[model], case.motor, case.supply, case.window)
    return Diagnosis(
        verdict=verdict,
        mu_f=level,
        mu_f_ci95=level_ci95(estimates.level_ci95, arranged),
        theta_f=theta_f if named else None,
        load_level=estimates.load_level,
        time_offset_s=estimates.offset_s,
        residual_rms_A=residual_rms_A(case, playback.trajectories(candidate_of(case, fit)).current[0]),
        evaluations=evaluations,
        compute_seconds=perf_counter() - begun,
        quality=tuple(quality),
        reasons=tuple(reasons),
        model=str(model),
        method=str(method),
        mu_f_scatter95=estimates.level_scatter95,
        load_level_ci95=estimates.load_ci95,
        load_level_scatter95=estimates.load_scatter95,
        speed_rpm=_speed_rpm(case, estimates),
        detection_limit=estimates.detection_limit,
        indicators=indicators(case),
        currents_only=assumed,
        fit=fit,
        phase_probabilities=phase_probabilities(evidence, case),
        hypotheses=hypotheses_of(evidence, case),
    )


def learn_baseline(recordings: Iterable[Recording], motor: Motor, *, currents_only: bool = False) -> Baseline:
    """Learn the motor's standing asymmetry from recordings known to be healthy.

    Parameters
    ----------
    recordings : iterable of Recording
        At least three recordings.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    currents_only : bool, default False
        Use no voltages, recorded or not.

    Returns
    -------
    Baseline
        The baseline.

    Raises
    ------
    RecordingError
        If a recording lacks channels that the motor needs.
    DiagnosisError
        If one is undiagnosable, or there are too few.
    """
    seen: list[tuple[complex, complex]] = []
    for recording in recordings:
        acceptance = accept(recording, motor, currents_only=currents_only)
        accepted = acceptance.accepted
        if accepted is None:
            failed = ", ".join(finding.name for finding in acceptance.quality if not finding.passed)
            raise DiagnosisError(f"{recording.source or 'recording'}: not fit for a baseline: {failed}")
        try:
            figures = _figures(accepted, None)
            known = Known(supply_unbalance=SUPPLY_UNBALANCE if acceptance.voltages_assumed else 0.0)
            seen.append(standing(weigh_stator(figures, accepted.case.motor, known)))
        except (np.linalg.LinAlgError, ArithmeticError) as error:
            what = not_computable(str(error)).message
            raise DiagnosisError(
                f"{recording.source or 'recording'}: not fit for a baseline: {what}"
            ) from error
    return baseline_of(seen)


def candidate_of(case: Case, fit: FittedParameters) -> Candidates:
    """Return a fitted hypothesis as the machine models take it."""
    # Exchanging terminals twice gives the first order: the way back is the way there.
    winding = case.terminal_winding(fit.theta_f)
    return Candidates(
        fault_level=np.array([fit.mu_f]),
        winding=np.array([winding], dtype=np.int64),
        load_level=np.array([fit.load_level]),
        time_offset_s=np.array([fit.time_offset_s]),
        leakage=np.array([fit.leakage]),
        axis_rad=np.array([fit.axis_rad]),
        linkage=np.array([fit.linkage]),
    )


def _check_known(method: str, model: str) -> None:
    if model not in MODELS:
        raise DiagnosisError(f"model {model!r} is unknown; known: {', '.join(MODELS)}")
    known = (Method.EVIDENCE, *METHODS)
    if method not in known:
        raise DiagnosisError(f"method {method!r} is unknown; known: {', '.join(known)}")


def _figures(accepted: Accepted, baseline: Baseline | None) -> RecordFigures:
    figures = figures_of(accepted.terminals, accepted.case, accepted.phasors)
    return figures if baseline is None else baseline.taken_off_figures(figures)


def _known(figures: RecordFigures, baseline: Baseline | None, supply_unbalance: float) -> Known:
    if baseline is None:
        return Known(supply_unbalance=supply_unbalance)
    volts = figures.positive_voltage_V
    return Known(
        1.0 - baseline.remaining, baseline.unbalance_V / volts, baseline.error_A / volts, supply_unbalance
    )


def _fitted(case: Case, evidence: StatorEvidence, estimates: Estimates) -> FittedParameters:
    """Return the shorted turns that come nearest, at the level that is told."""
    nearest = estimates if estimates.is_faulted else nearest_turns(evidence)
    turns = nearest.turns
    return FittedParameters(
        mu_f=turns.level,
        theta_f=case.terminal_winding(turns.winding),
        load_level=nearest.load_level,
        time_offset_s=nearest.offset_s,
        leakage=turns.leakage,
        axis_rad=atan2(turns.ahead.imag, turns.ahead.real),
        linkage=abs(turns.ahead),
    )


def _refined(case: Case, fit: Fit) -> FittedParameters:
    return FittedParameters(
        mu_f=fit.value(FAULT_LEVEL),
        theta_f=case.terminal_winding(int(fit.candidate.winding[0])),
        load_level=fit.value(LOAD_LEVEL),
        time_offset_s=fit.value(TIME_OFFSET),
        leakage=float(fit.candidate.leakage[0]),
        axis_rad=float(fit.candidate.axis_rad[0]),
        linkage=float(fit.candidate.linkage[0]),
    )


def _speed_rpm(case: Case, estimates: Estimates) -> float | None:
    """Speed of the shaft; None where the resistance of the rotor circuit is unknown."""
    if resistance_ratios(case.motor).are_open:
        return None
    speed = np.array([(1.0 - estimates.slip) * case.supply.angular_frequency])
    return float(electrical_to_rpm(speed, case.motor.nameplate.pole_pairs)[0])


def _refused(
    quality: list[QualityFinding], seconds: float, model: str, method: str, *, currents_only: bool
) -> Diagnosis:
    return Diagnosis(
        verdict=Verdict.UNDIAGNOSABLE,
        mu_f=None,
        mu_f_ci95=None,
        theta_f=None,
        load_level=None,
        time_offset_s=None,
        residual_rms_A=None,
        evaluations=0,
        compute_seconds=seconds,
        quality=tuple(quality),
        reasons=tuple(f"{finding.name}: {finding.message}" for finding in quality if not finding.passed),
        model=str(model),
        method=str(method),
        currents_only=currents_only,
    )
