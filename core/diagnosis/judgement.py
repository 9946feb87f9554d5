"""The verdict and its reasons: the fits compared with the effects of noise, sensors and parameters."""

from collections.abc import Callable

from core.diagnosis.case import Case
from core.diagnosis.hypotheses import Explanation, is_another_asymmetry, is_explained
from core.diagnosis.parameter_check import check_parameters
from core.diagnosis.refinement import (
    FAULT_LEVEL,
    LOAD_LEVEL,
    PATH_RATIO,
    TIME_OFFSET,
    Fit,
)
from core.diagnosis.tolerance import Systematic, negative_impedance_deviation
from core.diagnosis.verdict import Verdict
from core.machines.typical import TYPICAL_REASON
from core.quality.finding import QualityFinding, finding
from core.quantity_text import plain

PARAMETERS_DO_NOT_FIT = "the parameters do not fit"
"""So begins the reason of a record that is no more than this."""
COMMISSION_IT = "commission this motor (mcc commission), and check nameplate and ratios"
MOST_LOAD = 1.25
"""Load level beyond which the load is not believed: motors are made for 1, with a service factor of 1.15."""
PHASES = ("a", "b", "c")
USUAL_OFFSET_CYCLES = 1 / 80
"""Offset in cycles (250 us at 50 Hz) up to which sensors and parameters within 10 % account for it."""
DOUBTFUL_OFFSET_CYCLES = 1 / 24
"""Offset in cycles (830 us at 50 Hz) beyond which it is likelier that the motor is another, or a ratio wrong:
twice the true currents need 900 us and more, severe faults with parameters 10 % off up to 660."""


def judge(
    case: Case, explanation: Explanation, tolerance: Systematic, level_ci95: tuple[float, float]
) -> tuple[Verdict, list[str]]:
    """Decide on a verdict, with its reasons in words.

    With typical parameters of the rating nothing is called a fault.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    explanation : Explanation
        The hypothesis that explains the currents best.
    tolerance : Systematic
        Errors that no averaging reduces.
    level_ci95 : tuple of float
        95 % interval of the fault level from all causes.

    Returns
    -------
    verdict : Verdict
        The verdict.
    reasons : list of str
        Its reasons.
    """
    verdict, reasons = _judged(case, explanation, tolerance, level_ci95)
    if not case.motor.is_typical:
        return verdict, reasons
    return (Verdict.WATCH if verdict is Verdict.FAULT else verdict), [
        *reasons[:1],
        TYPICAL_REASON,
        *reasons[1:],
    ]


def _judged(
    case: Case, explanation: Explanation, tolerance: Systematic, level_ci95: tuple[float, float]
) -> tuple[Verdict, list[str]]:
    limit = case.motor.limits.fault_level
    fit = explanation.fit
    phase = PHASES[case.terminal_winding(explanation.winding)]
    low, high = (max(0.0, bound) for bound in level_ci95)
    level = f"{max(0.0, fit.value(FAULT_LEVEL)):.2%} (95 % interval {low:.2%} to {high:.2%})"
    scatter_low, scatter_high = (max(0.0, bound) for bound in fit.interval(FAULT_LEVEL))
    detectable = tolerance.detection_limit(fit, limit)
    figures = [
        f"backward-turning current that the supply does not cause is {explanation.asymmetry:.2%} of the "
        f"forward one; shorted turns in phase {phase} leave {explanation.unexplained:.2%}",
        f"sensors and parameters within their tolerances can feign {tolerance.backward:.2%} of the forward "
        f"current, {tolerance.level:.2%} of the turns (standard deviation); a fault below {detectable:.2%} "
        "could not be seen here for sure; the record's own scatter is "
        f"{scatter_low:.2%} to {scatter_high:.2%}",
    ]
    figures.append(_unknowns(case, fit))
    offset = fit.value(TIME_OFFSET)
    # An offset is only defined where voltages were recorded.
    late = 0.0 if case.voltages_assumed else abs(offset) * case.frequency_hz
    unusual = is_unusual(fit, case)
    check = None if case.voltages_assumed else check_parameters(explanation.record, case.motor)
    if unusual:
        figures.append(
            f"the currents lie {offset * 1e6:.0f} us behind the voltages, more than one relay's channels do: "
            "if they were recorded together, nameplate, ratios or parameters are not this motor's"
        )
    path = fit.value(PATH_RATIO)
    bridged = f", bridged by {plain(path, 2)} times the turns' own resistance" if path > 0.0 else ""
    explained = is_explained(explanation, tolerance)
    edges = {LOAD_LEVEL, TIME_OFFSET}.intersection(fit.at_bound)
    if edges:
        return Verdict.WATCH, [
            f"the fit ends at the edge of what is searched ({', '.join(sorted(edges))}): nameplate, "
            f"parameters or ratios are not this motor's; nearest are shorted turns in phase {phase}, {level}",
            *figures,
        ]
    if explained and low > limit and fit.value(FAULT_LEVEL) > tolerance.least_fault(fit, limit):
        if late > DOUBTFUL_OFFSET_CYCLES:
            return Verdict.WATCH, [
                "no motor with this nameplate lags so: check ratios and parameters first; nearest are "
                f"shorted turns in phase {phase}, {level}{bridged}",
                *figures,
            ]
        return Verdict.FAULT, [
            f"shorted turns in phase {phase}: {level}, above the limit of {limit:.2%}{bridged}",
            *figures,
        ]
    if is_another_asymmetry(explanation, tolerance):
        return Verdict.WATCH, ["an asymmetry that shorted turns in no phase explain", *figures]
    if scatter_high > limit:
        return Verdict.WATCH, [
            f"shorted turns in phase {phase} cannot be excluded: {level}, limit {limit:.2%}{bridged}",
            *figures,
        ]
    # Shorted turns below a high limit draw a current of their own.
    if check is not None and low <= 0.0 and (check.contradicts or (unusual and check.needs_offset)):
        return Verdict.WATCH, [
            f"{PARAMETERS_DO_NOT_FIT}: {check.reason}; {COMMISSION_IT}. No shorted turns are seen above the "
            f"limit of {limit:.2%}",
            *figures,
        ]
    return Verdict.HEALTHY, [
        f"no shorted turns seen above the limit of {limit:.2%}: best fit {level}",
        *figures,
    ]


def is_unusual(fit: Fit, case: Case) -> bool:
    """Tell whether a fit has an offset that sensors and parameters hardly account for.

    Parameters
    ----------
    fit : Fit
        The fit.
    case : Case
        The record in the winding frame.

    Returns
    -------
    bool
        Whether it does; an offset is only defined where voltages were recorded.
    """
    offset = abs(fit.value(TIME_OFFSET)) * case.frequency_hz
    return not case.voltages_assumed and offset > USUAL_OFFSET_CYCLES


def with_load(
    verdict: Verdict, reasons: list[str], load_ci95: tuple[float, float], advice: Callable[[], str]
) -> tuple[Verdict, list[str]]:
    """Judge the load: more than a motor bears for long is a sign that the record or the nameplate is not its.

    Parameters
    ----------
    verdict : Verdict
        The verdict without it.
    reasons : list of str
        Its reasons.
    load_ci95 : tuple of float
        95 % interval of the load level from all causes.
    advice : callable
        Returns which ratio would explain the currents; "" for none. It is asked only where it is told.

    Returns
    -------
    verdict : Verdict
        The verdict, which is not "healthy" with such a load.
    reasons : list of str
        Its reasons.
    """
    if load_ci95[0] <= MOST_LOAD:
        return verdict, reasons
    load = (
        f"a load of {load_ci95[0]:.2f} to {load_ci95[1]:.2f} times the rated torque is more than a motor "
        f"bears for long: {advice() or 'check nameplate and ratios'}"
    )
    if verdict is Verdict.HEALTHY:
        return Verdict.WATCH, [load, *reasons]
    return verdict, [*reasons[:1], load, *reasons[1:]]


def identified(explanation: Explanation, advice: Callable[[], str]) -> QualityFinding:
    """Check that the fits ended somewhere.

    That is a machine that can run so, with unknowns that the record tells apart.

    Parameters
    ----------
    explanation : Explanation
        The hypothesis that explains the currents best.
    advice : callable
        Returns which ratio would explain the currents; "" for none. It is asked only where it is told.

    Returns
    -------
    QualityFinding
        The finding.
    """
    unsound = sum(not fit.is_sound for fit in (explanation.fit, explanation.healthy))
    ratio = advice() if unsound else ""
    return finding(
        "identifiability", unsound, 0, "fits", passed=unsound == 0,
        message="no steady running of this motor comes near the record, or the record does not tell load, "
        "level and offset apart: nameplate and parameters, or the recording, are not this motor's: "
        f"{COMMISSION_IT}"
        + (f"; {ratio}" if ratio else ""),
    )  # fmt: skip


def _unknowns(case: Case, fit: Fit) -> str:
    """Say what else the fit estimated, and what it held."""
    path = ", resistance of the path" if PATH_RATIO in fit.standard_error else ""
    sensors, frequency = case.motor.sensors, case.frequency_hz
    return (
        f"estimated beside the level: frequency ({case.frequency_hz:.2f} Hz), load, offset of the currents "
        f"({fit.value(TIME_OFFSET) * 1e6:+.0f} us){path}; held and only bounded, by standard deviations: the "
        f"channels' ratios (voltages {sensors.voltage_deviation(frequency):.1%} each, currents "
        f"{sensors.current_deviation(frequency):.1%}), the motor's resistances and inductances "
        f"({negative_impedance_deviation(case.motor):.0%} of its negative-sequence impedance)"
    )
