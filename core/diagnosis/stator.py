"""Diagnosis of one recording: quality gate, global search, refinement, choice of hypothesis, verdict."""

from collections.abc import Iterable
from time import perf_counter

import numpy as np

from core.diagnosis.assumed_supply import SUPPLY_UNBALANCE
from core.diagnosis.baseline import Baseline, baseline_of, standing_current
from core.diagnosis.case import LONGEST_RECORD_S, Case, case_of
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.hypotheses import UNLIKELY, Explanation, explain, is_explained
from core.diagnosis.indicators import indicators
from core.diagnosis.quality import examine
from core.diagnosis.refinement import (
    CHANNEL_RATIO,
    FAULT_LEVEL,
    LOAD_LEVEL,
    PATH_RATIO,
    TIME_OFFSET,
    Fit,
)
from core.diagnosis.search import DEFAULT_METHOD, METHODS, search
from core.diagnosis.tolerance import PARAMETERS, Systematic, systematic
from core.diagnosis.verdict import Diagnosis, QualityFinding, Verdict
from core.machines.base import StatorModel
from core.machines.parameters import Motor
from core.machines.playback import Playback, electrical_to_rpm
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from core.recordings import Recording, RecordingError
from core.signals.terminals import terminals

MODELS: dict[str, StatorModel] = {model.name: model for model in (SplitWinding(), ShortedWinding())}
PHASES = ("a", "b", "c")
USUAL_OFFSET_CYCLES = 1 / 80
"""Offset in cycles (250 us at 50 Hz) up to which sensors and parameters within 10 % account for it."""


def diagnose(
    recording: Recording,
    motor: Motor,
    *,
    method: str = DEFAULT_METHOD,
    model: str = "split-winding",
    baseline: Baseline | None = None,
    currents_only: bool = False,
) -> Diagnosis:
    """Diagnose the stator winding from one recording in steady running.

    method: global search, one of search.METHODS.  model: one of MODELS; mu_f is its equivalent level.
    baseline: the motor's standing asymmetry (learn_baseline), taken off the currents first.
    currents_only: accept a recording without voltages; a balanced supply is assumed, and the verdict is never
    better than "watch".
    Raises RecordingError where the recording lacks channels the motor needs, DiagnosisError for an unknown
    method or model. Everything else a recording can be guilty of makes it undiagnosable, with the reason.
    """
    begun = perf_counter()
    _check_known(method, model)
    case, quality, assumed = _accept(recording, motor, currents_only=currents_only)
    if case is None:
        return _refused(quality, perf_counter() - begun, model, method)
    if baseline is not None:
        case = baseline.taken_off(case)
    playback = Playback(MODELS[model], motor, case.supply, case.window)
    starts = search(case, playback.model, method)
    explanation = explain(case, playback.model, starts)
    tolerance = systematic(
        case,
        playback,
        explanation.fit,
        known_share=0.0 if baseline is None else 1.0 - baseline.remaining,
        supply_unbalance=SUPPLY_UNBALANCE if assumed else 0.0,
    )
    verdict, reasons = judge(case, explanation, tolerance)
    if assumed and verdict is Verdict.FAULT:
        verdict = Verdict.WATCH
    if assumed:
        reasons.append("no voltages recorded: a balanced supply is assumed, so this is no better than a hint")
    if baseline is not None:
        reasons.append(f"relative to a baseline of {baseline.recordings} healthy recordings")
    fit = explanation.fit
    named = verdict is Verdict.FAULT or (verdict is Verdict.WATCH and is_explained(explanation, tolerance))
    # Load and speed belong to the hypothesis believed: a level too small to believe would bend them.
    running = fit if named else explanation.healthy
    low, high = (max(0.0, bound) for bound in fit.interval(FAULT_LEVEL))
    return Diagnosis(
        verdict=verdict,
        mu_f=max(0.0, fit.value(FAULT_LEVEL)),
        mu_f_ci95=(low, high),
        theta_f=case.terminal_winding(explanation.winding) if named else None,
        load_level=running.value(LOAD_LEVEL),
        time_offset_s=running.value(TIME_OFFSET),
        residual_rms_A=_residual_rms(case, playback, fit),
        evaluations=starts.evaluations + explanation.evaluations,
        compute_seconds=perf_counter() - begun,
        quality=tuple(quality),
        reasons=tuple(reasons),
        model=model,
        method=method,
        load_level_ci95=running.interval(LOAD_LEVEL),
        speed_rpm=_speed_rpm(case, playback, running),
        detection_limit=tolerance.detection_limit(fit),
        indicators=indicators(case),
    )


def learn_baseline(recordings: Iterable[Recording], motor: Motor, *, currents_only: bool = False) -> Baseline:
    """The motor's standing asymmetry from recordings known to be healthy, at least three of them.

    Raises RecordingError like `diagnose`, DiagnosisError where one is undiagnosable or there are too few.
    """
    seen: list[complex] = []
    for recording in recordings:
        case, quality, _ = _accept(recording, motor, currents_only=currents_only)
        if case is None:
            failed = ", ".join(finding.name for finding in quality if not finding.passed)
            raise DiagnosisError(f"{recording.source or 'recording'}: not fit for a baseline: {failed}")
        model = SplitWinding()
        seen.append(standing_current(explain(case, model, search(case, model, DEFAULT_METHOD))))
    return baseline_of(seen)


def judge(case: Case, explanation: Explanation, tolerance: Systematic) -> tuple[Verdict, list[str]]:
    """Verdict and its reasons in words."""
    limit = case.motor.limits.fault_level
    fit = explanation.fit
    low, high = fit.interval(FAULT_LEVEL)
    reach = tolerance.reach(fit)
    phase = PHASES[case.terminal_winding(explanation.winding)]
    level = f"{fit.value(FAULT_LEVEL):.2%} (95 % interval {max(0.0, low):.2%} to {max(0.0, high):.2%})"
    figures = [
        f"backward-turning current that the supply does not cause is {explanation.asymmetry:.2%} of the "
        f"forward one; shorted turns in phase {phase} leave {explanation.unexplained:.2%}",
        f"sensors and parameters within their tolerances can feign {tolerance.backward:.2%} of it, "
        f"{tolerance.level:.2%} of the turns (standard deviation); a fault below "
        f"{tolerance.detection_limit(fit):.2%} could not be seen here for sure",
    ]
    offset = fit.value(TIME_OFFSET)
    figures.append(_unknowns(case, fit))
    if abs(offset) * case.frequency_hz > USUAL_OFFSET_CYCLES:
        figures.append(
            f"the currents lie {offset * 1e6:.0f} us behind the voltages, more than one relay's channels do: "
            "if they were recorded together, nameplate or parameters are not this motor's"
        )
    path = fit.value(PATH_RATIO)
    bridged = f", bridged by {path:.2g} times the turns' own resistance" if path > 0.0 else ""
    explained = is_explained(explanation, tolerance)
    if explained and min(low, fit.value(FAULT_LEVEL) - reach) > limit:
        return Verdict.FAULT, [
            f"shorted turns in phase {phase}: {level}, above the limit of {limit:.2%}{bridged}",
            *figures,
        ]
    if not explained and explanation.unexplained > UNLIKELY * tolerance.backward:
        return Verdict.WATCH, ["an asymmetry that shorted turns in no phase explain", *figures]
    if high > limit:
        return Verdict.WATCH, [
            f"shorted turns in phase {phase} cannot be excluded: {level}, limit {limit:.2%}{bridged}",
            *figures,
        ]
    return Verdict.HEALTHY, [f"no shorted turns above the limit of {limit:.2%}: best fit {level}", *figures]


def _unknowns(case: Case, fit: Fit) -> str:
    """What else the fit could turn at, and what it could not."""
    path = ", resistance of the path" if PATH_RATIO in fit.standard_error else ""
    return (
        f"estimated beside the level: frequency ({case.frequency_hz:.2f} Hz), load, offset of the currents "
        f"({fit.value(TIME_OFFSET) * 1e6:+.0f} us){path}; held and only bounded, by standard deviations: the "
        f"channels' ratios ({CHANNEL_RATIO:.1%} each), the motor's resistances and inductances "
        f"({PARAMETERS:.0%} of its negative-sequence impedance)"
    )


def _check_known(method: str, model: str) -> None:
    if model not in MODELS:
        raise DiagnosisError(f"model {model!r} is unknown; known: {', '.join(MODELS)}")
    if method not in METHODS:
        raise DiagnosisError(f"method {method!r} is unknown; known: {', '.join(METHODS)}")


def _accept(
    recording: Recording, motor: Motor, *, currents_only: bool
) -> tuple[Case | None, list[QualityFinding], bool]:
    """The case the stages work on, or None where a check fails; every check's finding; whether the voltages
    are assumed."""
    measured = terminals(
        recording,
        currents=motor.channels.currents,
        phase_voltages=None if currents_only else motor.channels.phase_voltages,
        line_voltages=None if currents_only else motor.channels.line_voltages,
        longest_s=LONGEST_RECORD_S,
    )
    assumed = measured.voltage_ab is None
    if assumed and not currents_only:
        raise RecordingError(
            recording.source,
            "voltages",
            expected="three phase voltages or two line voltages beside the currents",
            found="none: without them an unbalanced supply cannot be told from a fault",
        )
    quality, passed = examine(measured, motor)
    if passed is None:
        return None, quality, assumed
    rate, frequency = measured.sample_rate_hz, passed.frequency_hz
    case = case_of(motor, measured.current_abc, passed.voltage_ab, rate, frequency, passed.sequence)
    return case, quality, assumed


def _speed_rpm(case: Case, playback: Playback, fit: Fit) -> float:
    mean = playback.steady_state(fit.candidate).mean_speed
    return float(electrical_to_rpm(mean, case.motor.nameplate.pole_pairs)[0])


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


def _residual_rms(case: Case, playback: Playback, fit: Fit) -> float:
    window = case.window
    modelled = playback.trajectories(fit.candidate).current[0]
    residual = case.space_vector(case.current_ab[:, window.first : window.last] - modelled)
    return float(np.sqrt(np.mean(np.abs(residual) ** 2))) * case.line_per_winding_current
