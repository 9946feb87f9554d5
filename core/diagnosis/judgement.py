"""The verdict of one record and its reasons: what the evidence over all hypotheses says, in words."""

from collections.abc import Callable
from typing import Final

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.causes import IN_WORDS, Cause
from core.diagnosis.estimates import Estimates
from core.diagnosis.phase_words import NAMED_PHASE, phase_in_words
from core.diagnosis.record_errors import HEALTHY
from core.diagnosis.stator_evidence import CALLED, StatorEvidence
from core.diagnosis.turns_place import axis_of, phases_of
from core.diagnosis.verdict import Hypothesis, Verdict
from core.machines.base import Array
from core.machines.typical import TYPICAL_REASON
from core.quality.finding import QualityFinding, finding

COMMISSION_IT: Final = "commission this motor (mcc commission), and check nameplate and ratios"
MOST_LOAD: Final = 1.25
"""Load level beyond which the load is not believed: motors are made for 1, with a service factor of 1.15."""
PHASES: Final = ("a", "b", "c")
POSSIBLE_CAUSE: Final = 0.05
"""Probability from which on another explanation is told beside the likeliest."""
USUAL_OFFSET_CYCLES: Final = 1 / 80
"""Offset in cycles (250 us at 50 Hz) up to which sensors and parameters within 10 % account for it."""
DOUBTFUL_OFFSET_CYCLES: Final = 1 / 24
"""Offset in cycles (830 us at 50 Hz) beyond which it is likelier that the motor is another, or a ratio
wrong."""
GENERATES: Final = "it feeds power back, as a motor does that its load drives (it generates); else "
SLIP_RINGS: Final = (
    "the phase is not named: a wound rotor does not damp the harmonics of single coils, and it was not shown "
    "that a record of such a motor tells the phase"
)
WHAT_TO_DO: Final = {
    Cause.VOLTAGE_CHANNEL: "measure the voltages at the relay's terminals",
    Cause.CURRENT_CHANNEL: "compare the relay's currents with a clamp meter",
    Cause.CONNECTION: "measure the resistances of the three phases from the contactor on, the motor off",
    Cause.BEHIND_RELAY: "check what else the relay measures: capacitors and their fuses, heaters, lighting",
    Cause.ASYMMETRY: "further records at other loads tell whether it is one of shorted turns",
    Cause.PARAMETERS: COMMISSION_IT,
}


def judge(
    case: Case, evidence: StatorEvidence, estimates: Estimates, advice: Callable[[], str]
) -> tuple[Verdict, list[str]]:
    """Decide on a verdict, with its reasons in words.

    With typical parameters of the rating, and without voltages, nothing is called a fault.
    """
    verdict, first = _judged(case, evidence, estimates)
    ratio = advice() if evidence.answer is Cause.PARAMETERS else ""
    reasons = [f"{first}; {ratio}" if ratio else first]
    if case.motor.is_typical:
        reasons.append(TYPICAL_REASON)
    if case.voltages_assumed:
        reasons.append("no voltages recorded: a balanced supply is assumed, so this is no better than a hint")
    if verdict is Verdict.FAULT and (case.motor.is_typical or case.voltages_assumed):
        verdict = Verdict.WATCH
    if verdict is not Verdict.HEALTHY and evidence.answer is Cause.SHORTED_TURNS:
        reasons += _place(case, evidence)
    reasons += _figures(case, evidence, estimates)
    return verdict, reasons


def _judged(case: Case, evidence: StatorEvidence, estimates: Estimates) -> tuple[Verdict, str]:
    limit, answer = case.motor.limits.fault_level, evidence.answer
    probability = evidence.probability[answer]
    low, high = estimates.level_ci95
    level = f"{estimates.level:.2%} (95 % interval {low:.2%} to {high:.2%})"
    others = _others(evidence)
    if answer is Cause.SHORTED_TURNS:
        where = phase_words(evidence, case)
        if probability < CALLED:
            return Verdict.WATCH, f"shorted turns{where} are likeliest ({probability:.0%}){others}: {level}"
        if is_doubtful_offset(estimates.offset_s, case):
            generates = GENERATES if evidence.errors.figures.admittance.real < 0.0 else ""
            return Verdict.WATCH, (
                f"{generates}no motor with this nameplate lags so: check ratios and parameters first; "
                f"nearest are shorted turns{where}, {level}"
            )
        if high < limit:
            return Verdict.HEALTHY, f"shorted turns{where}: {level}, below the limit of {limit:.2%}"
        if low <= limit:
            return Verdict.WATCH, f"shorted turns{where}: {level}, not surely above the limit of {limit:.2%}"
        return Verdict.FAULT, f"shorted turns{where}: {level}, above the limit of {limit:.2%}"
    if answer is not Cause.HEALTHY:
        figure = evidence.others[answer].figure
        what = f"{IN_WORDS[answer]} ({probability:.0%}){others}: {figure}"
        return Verdict.WATCH, f"{what}; {WHAT_TO_DO[answer]}"
    late = not case.voltages_assumed and abs(estimates.offset_s) * case.frequency_hz > USUAL_OFFSET_CYCLES
    if late and evidence.log_likelihood_ratio[Cause.PARAMETERS] > 0.0:
        return Verdict.WATCH, (
            f"the parameters do not fit: the currents lie {estimates.offset_s * 1e6:.0f} us behind the "
            f"voltages, more than one relay's channels do; {COMMISSION_IT}. No shorted turns are seen"
        )
    scatter = estimates.level_scatter95[1]
    if scatter > limit and evidence.log_likelihood_ratio[Cause.SHORTED_TURNS] > 0.0:
        return Verdict.WATCH, (
            f"shorted turns{phase_words(evidence, case)} cannot be excluded: {level}, limit {limit:.2%}"
        )
    return Verdict.HEALTHY, f"no shorted turns seen above the limit of {limit:.2%}: best fit {level}"


def phase_probabilities(evidence: StatorEvidence, case: Case) -> tuple[float, float, float] | None:
    """Return the probability that shorted turns, if there are any, lie on terminal a, b, c."""
    a, b, c = evidence.turns.phase_probability.tolist()
    return phases_of((a, b, c), case.motor, case.sequence)


def names_phase(evidence: StatorEvidence, case: Case) -> bool:
    """Return whether the phase of shorted turns is named."""
    found = phase_probabilities(evidence, case)
    return found is not None and max(found) >= NAMED_PHASE


def phase_words(evidence: StatorEvidence, case: Case) -> str:
    """Return the phase of shorted turns, such as " in phase a" or " in phase a (72 %) or c (28 %)"."""
    words = phase_in_words(phase_probabilities(evidence, case))
    return f" in phase {words}" if words else ""


def hypotheses_of(evidence: StatorEvidence, case: Case) -> tuple[Hypothesis, ...]:
    """Return what was weighed, the likeliest first."""
    ratios = evidence.log_likelihood_ratio
    low, middle, high = (evidence.turns.level_quantile(q) for q in (0.025, 0.5, 0.975))
    figures = {cause: one.figure for cause, one in evidence.others.items()} | {
        Cause.HEALTHY: "no cause at all",
        Cause.SHORTED_TURNS: (
            f"equivalent level {middle:.1%} ({low:.1%} to {high:.1%}){phase_words(evidence, case)}"
        ),
    }
    return tuple(
        Hypothesis(cause, evidence.probability[cause], ratios[cause], figures[cause])
        for cause in sorted(ratios, key=lambda one: -evidence.probability[one])
    )


def is_doubtful_offset(offset_s: float, case: Case) -> bool:
    """Tell whether an offset is longer than the channels of a relay have."""
    return not case.voltages_assumed and abs(offset_s) * case.frequency_hz > DOUBTFUL_OFFSET_CYCLES


def with_load(
    verdict: Verdict, reasons: list[str], load_ci95: tuple[float, float], advice: Callable[[], str]
) -> tuple[Verdict, list[str]]:
    """Judge the load: more than a motor bears for long is a sign of another record or nameplate."""
    if load_ci95[0] <= MOST_LOAD:
        return verdict, reasons
    load = (
        f"a load of {load_ci95[0]:.2f} to {load_ci95[1]:.2f} times the rated torque is more than a motor "
        f"bears for long: {advice() or 'check nameplate and ratios'}"
    )
    if verdict is Verdict.HEALTHY:
        return Verdict.WATCH, [load, *reasons]
    return verdict, [*reasons[:1], load, *reasons[1:]]


def identified(evidence: StatorEvidence, advice: Callable[[], str]) -> QualityFinding:
    """Check that the motor can run as the record shows."""
    slips, slip = evidence.slips, evidence.slip
    ends = not slips.lowest < slip < slips.highest
    unsound = int(ends or not np.isfinite(list(evidence.log_likelihood_ratio.values())).all())
    ratio = advice() if unsound else ""
    return finding(
        "identifiability", unsound, 0, "fits", passed=unsound == 0,
        message="no steady running of this motor comes near the record: nameplate and parameters, or the "
        f"recording, are not this motor's: {COMMISSION_IT}"
        + (f"; {ratio}" if ratio else ""),
    )  # fmt: skip


def _others(evidence: StatorEvidence) -> str:
    """Say what else it may be."""
    found = sorted(evidence.probability.items(), key=lambda one: -one[1])[1:]
    told = [f"{IN_WORDS[cause]} ({share:.0%})" for cause, share in found if share >= POSSIBLE_CAUSE]
    return f", else {' or '.join(told)}" if told else ""


def _place(case: Case, evidence: StatorEvidence) -> list[str]:
    """Say why no phase is named, or on which axis the coil lies."""
    if case.motor.wound_rotor is not None:
        return [SLIP_RINGS]
    turns = evidence.turns
    axis = axis_of(turns.prior.angle_rad, turns.axis_probability, case.motor, case.sequence)
    if axis is None or not names_phase(evidence, case):
        return []
    phase = PHASES[case.terminal_winding(turns.likeliest_phase.winding)]
    return [f"the turns lie in coils of the axis {axis:+.0f} degrees of phase {phase}"]


def _figures(case: Case, evidence: StatorEvidence, estimates: Estimates) -> list[str]:
    own = _asymmetry(evidence)
    low, high = estimates.level_scatter95
    sensors, frequency = case.motor.sensors, case.frequency_hz
    told = [
        f"the asymmetry that the supply does not cause is {own[0]:.2%} of the voltage; channels and "
        f"parameters within their tolerances can look like {own[1]:.2%} (standard deviation)",
        f"a level below {estimates.detection_limit:.2%} would not surely be called here; the record's own "
        f"scatter is {low:.2%} to {high:.2%}",
        f"estimated beside the level: frequency ({frequency:.2f} Hz), load, offset of the currents "
        f"({estimates.offset_s * 1e6:+.0f} us), axis and leakage of the turns; held and only bounded, by "
        f"standard deviations: the channels' ratios (voltages {sensors.voltage_deviation(frequency):.1%} "
        f"each, currents {sensors.current_deviation(frequency):.1%}), resistances and inductances",
    ]
    late = abs(estimates.offset_s) * frequency
    if not case.voltages_assumed and late > USUAL_OFFSET_CYCLES:
        told.append(
            f"the currents lie {estimates.offset_s * 1e6:.0f} us behind the voltages, more than one relay's "
            "channels do: if they were recorded together, nameplate, ratios or parameters are not this "
            "motor's"
        )
    return told


def _asymmetry(evidence: StatorEvidence) -> tuple[float, float]:
    """Return the asymmetry of a record, and its standard deviation in a sound motor, shares of V1."""
    point = evidence.point
    left: Array = evidence.errors.residual(HEALTHY, point.slip, point.offset_s)
    spread = float(np.sqrt(point.covariance[2, 2] + point.covariance[3, 3]))
    return float(np.hypot(left[2], left[3])), spread
