"""Diagnosis of one recording: quality gate, global search, refinement, choice of hypothesis, verdict."""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from time import perf_counter

import numpy as np

from core.diagnosis.acceptance import Acceptance, accept, not_computable
from core.diagnosis.baseline import Baseline, baseline_of, standing
from core.diagnosis.case import Case
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.fundamental import fundamental_of
from core.diagnosis.hypotheses import Explanation, explain, is_explained
from core.diagnosis.indicators import indicators
from core.diagnosis.judgement import PARAMETERS_DO_NOT_FIT, identified, is_unusual, judge, with_load
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.propagation import Known, deviation, errors_of, of_the_likeliest_winding, widened
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, PATH_RATIO, TIME_OFFSET, Fit
from core.diagnosis.residual import residual_rms_A
from core.diagnosis.search import METHODS, search
from core.diagnosis.tolerance import Systematic, systematic
from core.diagnosis.verdict import Diagnosis, FittedParameters, Verdict, not_finite
from core.machines.parameters import Motor
from core.machines.playback import Playback, electrical_to_rpm
from core.machines.split_winding import SplitWinding
from core.machines.stator_models import MODELS
from core.machines.wound_rotor import resistance_ratios
from core.quality.assumed_supply import SUPPLY_UNBALANCE
from core.quality.finding import QualityFinding
from core.quality.scale import current_scale_advice
from core.recordings import Recording

SPEED_UNKNOWN = (
    "the resistance at the slip rings is not known: the stator and the load are told all the same, slip and "
    "speed are not"
)


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
        Global search, one of `core.diagnosis.methods.Method`.
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
        Global search, one of `core.diagnosis.methods.Method`.
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
    case, phasors = accepted.case, accepted.phasors
    motor = case.motor
    if baseline is not None:
        case = baseline.taken_off(case)
        phasors = fundamental_of(case)
    playback = Playback(MODELS[model], motor, case.supply, case.window)
    starts = search(case, playback.model, method)
    known = _known(baseline, SUPPLY_UNBALANCE if assumed else 0.0)
    explanation = explain(case, phasors, playback.model, starts, known)
    advice = partial(current_scale_advice, accepted.terminals, motor)
    quality.append(identified(explanation, advice))
    if not quality[-1].passed:
        return _refused(quality, perf_counter() - begun, model, method, currents_only=assumed)
    fit = explanation.fit
    tolerance = systematic(case, playback, fit, known)
    level_ci95 = _level_interval(case, playback, explanation, tolerance, known)
    verdict, reasons = judge(case, explanation, tolerance, level_ci95)
    if assumed and verdict is Verdict.FAULT:
        verdict = Verdict.WATCH
    if assumed:
        reasons.insert(
            1, "no voltages recorded: a balanced supply is assumed, so this is no better than a hint"
        )
    if baseline is not None:
        reasons.append(baseline.reason)
    if resistance_ratios(motor).are_open:
        reasons.append(SPEED_UNKNOWN)
    explained = is_explained(explanation, tolerance)
    only_parameters = reasons[0].startswith(PARAMETERS_DO_NOT_FIT)
    named = verdict is Verdict.FAULT or (verdict is Verdict.WATCH and explained and not only_parameters)
    # Load and speed are those of the accepted hypothesis; an insignificant level would bias them. They do not
    # depend on the motor's limit: a level below a high limit is there all the same.
    faulted = named or (explained and level_ci95[0] > 0.0)
    # At light load a healthy machine may come nearest with an offset that no relay has.
    running = fit if faulted or is_unusual(explanation.healthy, case) else explanation.healthy
    load_ci95 = _load_interval(case, playback, explanation, known, faulted=faulted)
    verdict, reasons = with_load(verdict, reasons, load_ci95, advice)
    return Diagnosis(
        verdict=verdict,
        mu_f=max(0.0, fit.value(FAULT_LEVEL)),
        mu_f_ci95=_not_below_zero(level_ci95),
        theta_f=case.terminal_winding(explanation.winding) if named else None,
        load_level=running.value(LOAD_LEVEL),
        time_offset_s=running.value(TIME_OFFSET),
        residual_rms_A=residual_rms_A(case, playback.trajectories(fit.candidate).current[0]),
        evaluations=starts.evaluations + explanation.evaluations,
        compute_seconds=perf_counter() - begun,
        quality=tuple(quality),
        reasons=tuple(reasons),
        model=str(model),
        method=str(method),
        mu_f_scatter95=_not_below_zero(fit.interval(FAULT_LEVEL)),
        load_level_ci95=load_ci95,
        load_level_scatter95=running.interval(LOAD_LEVEL),
        speed_rpm=_speed_rpm(case, playback, running),
        detection_limit=tolerance.detection_limit(fit, motor.limits.fault_level),
        indicators=indicators(case),
        currents_only=assumed,
        fit=_parameters(case, fit),
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
        model = SplitWinding()
        try:
            starts = search(accepted.case, model, DEFAULT_METHOD)
            seen.append(standing(explain(accepted.case, accepted.phasors, model, starts)))
        except (np.linalg.LinAlgError, ArithmeticError) as error:
            what = not_computable(str(error)).message
            raise DiagnosisError(
                f"{recording.source or 'recording'}: not fit for a baseline: {what}"
            ) from error
    return baseline_of(seen)


def _check_known(method: str, model: str) -> None:
    if model not in MODELS:
        raise DiagnosisError(f"model {model!r} is unknown; known: {', '.join(MODELS)}")
    if method not in METHODS:
        raise DiagnosisError(f"method {method!r} is unknown; known: {', '.join(METHODS)}")


def _known(baseline: Baseline | None, supply_unbalance: float) -> Known:
    if baseline is None:
        return Known(supply_unbalance=supply_unbalance)
    return Known(1.0 - baseline.remaining, baseline.unbalance_V, baseline.error_A, supply_unbalance)


def _level_interval(
    case: Case, playback: Playback, explanation: Explanation, tolerance: Systematic, known: Known
) -> tuple[float, float]:
    """95 % interval of the fault level from all causes, below zero too."""
    fit = explanation.fit
    errors = errors_of(case, playback.model, explanation.record, fit.candidate, known)
    at_bound = FAULT_LEVEL in fit.at_bound
    systematic_level = tolerance.level if at_bound else deviation(fit, FAULT_LEVEL, errors)
    level = fit.value(FAULT_LEVEL)
    return of_the_likeliest_winding(level, widened(level, explanation.level_interval, systematic_level))


def _load_interval(
    case: Case, playback: Playback, explanation: Explanation, known: Known, *, faulted: bool
) -> tuple[float, float]:
    """95 % interval of the load from all causes.

    Where shorted turns are neither found nor excluded, it holds the loads of both hypotheses.
    """
    scatter = [(explanation.fit, explanation.load_interval)]
    if not faulted:
        scatter.append((explanation.healthy, explanation.healthy.interval(LOAD_LEVEL)))
    found = []
    for fit, interval in scatter:
        errors = errors_of(case, playback.model, explanation.record, fit.candidate, known)
        found.append(widened(fit.value(LOAD_LEVEL), interval, deviation(fit, LOAD_LEVEL, errors)))
    return min(low for low, _ in found), max(high for _, high in found)


def _not_below_zero(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    return max(0.0, low), max(0.0, high)


def _parameters(case: Case, fit: Fit) -> FittedParameters:
    return FittedParameters(
        mu_f=fit.value(FAULT_LEVEL),
        theta_f=case.terminal_winding(int(fit.candidate.winding[0])),
        load_level=fit.value(LOAD_LEVEL),
        time_offset_s=fit.value(TIME_OFFSET),
        path_ratio=fit.value(PATH_RATIO),
    )


def _speed_rpm(case: Case, playback: Playback, fit: Fit) -> float | None:
    """Speed of the fitted candidate; None where the resistance of the rotor circuit is unknown."""
    if resistance_ratios(case.motor).are_open:
        return None
    mean = playback.steady_state(fit.candidate).mean_speed
    return float(electrical_to_rpm(mean, case.motor.nameplate.pole_pairs)[0])


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
