"""Diagnosis of one recording: quality gate, global search, refinement, choice of hypothesis, verdict."""

from time import perf_counter

import numpy as np

from core.diagnosis.case import Case, case_of
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.hypotheses import Explanation, explain
from core.diagnosis.quality import electrical_condition, no_frequency, sampled_well
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, PATH_RATIO, TIME_OFFSET
from core.diagnosis.search import METHODS, search
from core.diagnosis.verdict import Diagnosis, QualityFinding, Verdict
from core.machines.base import Array, StatorModel
from core.machines.parameters import Motor
from core.machines.playback import Playback
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from core.recordings import Recording, RecordingError
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, fundamental_phasors
from core.signals.sequence import sequence_phasors
from core.signals.terminals import Terminals, terminals

MODELS: dict[str, StatorModel] = {model.name: model for model in (SplitWinding(), ShortedWinding())}
PHASES = ("a", "b", "c")
UNEXPLAINED_LIMIT = 0.02
"""Backward-turning current, of the forward one, that sensors within their class can no longer account for."""


def diagnose(
    recording: Recording, motor: Motor, *, method: str = "hcpa", model: str = "split-winding"
) -> Diagnosis:
    """Diagnose the stator winding from one recording in steady running.

    method: global search, one of search.METHODS.  model: one of MODELS; mu_f is its equivalent level.
    Raises RecordingError where the recording lacks channels the motor needs, DiagnosisError for an unknown
    method or model. Everything else a recording can be guilty of makes it undiagnosable, with the reason.
    """
    begun = perf_counter()
    if model not in MODELS:
        raise DiagnosisError(f"model {model!r} is unknown; known: {', '.join(MODELS)}")
    if method not in METHODS:
        raise DiagnosisError(f"method {method!r} is unknown; known: {', '.join(METHODS)}")
    measured = terminals(
        recording,
        currents=motor.channels.currents,
        phase_voltages=motor.channels.phase_voltages,
        line_voltages=motor.channels.line_voltages,
    )
    if measured.voltage_ab is None:
        raise RecordingError(
            recording.source,
            "voltages",
            expected="three phase voltages or two line voltages beside the currents",
            found="none: without them an unbalanced supply cannot be told from a fault",
        )
    case, quality = _gate(measured, measured.voltage_ab, motor)
    if case is None:
        return _refused(quality, perf_counter() - begun, model, method)
    playback = Playback(MODELS[model], motor, case.supply, case.window)
    starts = search(case, playback, method)
    explanation = explain(case, playback, starts)
    verdict, reasons = judge(case, explanation)
    fit = explanation.fit
    named = verdict is Verdict.FAULT or (verdict is Verdict.WATCH and _is_shorted_turns(explanation))
    low, high = (max(0.0, bound) for bound in fit.interval(FAULT_LEVEL))
    return Diagnosis(
        verdict=verdict,
        mu_f=max(0.0, fit.value(FAULT_LEVEL)),
        mu_f_ci95=(low, high),
        theta_f=case.terminal_winding(explanation.winding) if named else None,
        load_level=fit.value(LOAD_LEVEL),
        time_offset_s=fit.value(TIME_OFFSET),
        residual_rms_A=_residual_rms(case, explanation),
        evaluations=starts.evaluations + explanation.evaluations,
        compute_seconds=perf_counter() - begun,
        quality=tuple(quality),
        reasons=tuple(reasons),
        model=model,
        method=method,
    )


def judge(case: Case, explanation: Explanation) -> tuple[Verdict, list[str]]:
    """Verdict and its reasons in words."""
    limit = case.motor.limits.fault_level
    fit = explanation.fit
    low, high = fit.interval(FAULT_LEVEL)
    phase = PHASES[case.terminal_winding(explanation.winding)]
    level = f"{fit.value(FAULT_LEVEL):.2%} (95 % interval {max(0.0, low):.2%} to {max(0.0, high):.2%})"
    backward = (
        f"backward-turning current that the supply does not cause is {explanation.asymmetry:.2%} of the "
        f"forward one; shorted turns in phase {phase} leave {explanation.unexplained:.2%}"
    )
    path = fit.value(PATH_RATIO)
    bridged = f", bridged by {path:.2g} times the turns' own resistance" if path > 0.0 else ""
    if low > limit and explanation.explained:
        return Verdict.FAULT, [
            f"shorted turns in phase {phase}: {level}, above the limit of {limit:.2%}{bridged}",
            backward,
        ]
    if explanation.unexplained > UNEXPLAINED_LIMIT or low > limit:
        return Verdict.WATCH, ["an asymmetry that shorted turns in no phase explain", backward]
    if high > limit:
        return Verdict.WATCH, [
            f"shorted turns in phase {phase} cannot be excluded: {level}, limit {limit:.2%}{bridged}",
            backward,
        ]
    return Verdict.HEALTHY, [f"no shorted turns above the limit of {limit:.2%}: best fit {level}", backward]


def _is_shorted_turns(explanation: Explanation) -> bool:
    return explanation.explained and explanation.unexplained <= UNEXPLAINED_LIMIT


def _gate(measured: Terminals, voltage_ab: Array, motor: Motor) -> tuple[Case | None, list[QualityFinding]]:
    """The case the stages work on, or None where a check fails; with every check's finding."""
    rate = measured.sample_rate_hz
    quality = sampled_well(measured, motor.nameplate)
    if not all(finding.passed for finding in quality):
        return None, quality
    try:
        frequency = fundamental_frequency(voltage_ab, rate)
    except SignalError as error:
        return None, [*quality, no_frequency(error, motor.nameplate)]
    quality += electrical_condition(measured, voltage_ab, frequency, motor.nameplate)
    if not all(finding.passed for finding in quality):
        return None, quality
    sequence = sequence_phasors(fundamental_phasors(voltage_ab, frequency, rate)).sequence
    return case_of(motor, measured.current_abc, voltage_ab, rate, frequency, sequence), quality


def _refused(quality: list[QualityFinding], seconds: float, model: str, method: str) -> Diagnosis:
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
        model=model,
        method=method,
    )


def _residual_rms(case: Case, explanation: Explanation) -> float:
    residual = case.space_vector(explanation.fit.residual_ab)
    return float(np.sqrt(np.mean(np.abs(residual) ** 2))) * case.line_per_winding_current
