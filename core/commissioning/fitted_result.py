"""What the fit of a motor to its starts tells: estimates with intervals, starts, reasons and warnings."""

from collections.abc import Iterator, Sequence
from dataclasses import astuple, replace
from math import exp, isinf, sqrt

import numpy as np

from core.commissioning.fit import Fit, Records
from core.commissioning.identifiability import Unidentifiable
from core.commissioning.load_change import found_load_change, in_words
from core.commissioning.plausibility import contradictions, delay_warning
from core.commissioning.prior import PARAMETERS, Prior
from core.commissioning.result import Commissioning, Estimate, StartFound
from core.commissioning.start import Start
from core.commissioning.uncertainty import (
    inherited_covariance,
    misfit,
    misfit_covariance,
    noise_covariance,
    quantile,
)
from core.commissioning.unknowns import LOGARITHMS, OF_A_CHANGE, OF_A_START, Point
from core.machines.base import Array
from core.machines.candidates import LoadLaw
from core.machines.load_point import load_point
from core.machines.motor_file.reader import Plate
from core.machines.parameters import Motor, ParametersSource

RUNNING_STEPS = 4
"""Steps of the fixed point of load and slip: each is a tenth as wrong as the one before."""
LIGHT_LOAD = 0.05
"""Load level below which the load law makes no difference."""
USUAL_RESIDUAL = 0.05
"""Unexplained share of the current above which a motor of constant parameters does not fit the record."""
USUAL_MISFIT = 0.003
"""Share of the current that motors as they are built leave beside a model of them, and noise."""


def fitted_result(
    records: Records,
    fit: Fit,
    fixed: list[Unidentifiable],
    plate: Plate,
    *,
    law_identified: bool,
    condition: float,
    evaluations: int,
    seconds: float,
) -> Commissioning:
    """Return what a fit tells. fixed: unknowns that were not identified, at which the fit held them."""
    coordinates, prior = records.coordinates, records.coordinates.prior
    point = coordinates.point(fit.vector)
    half = np.zeros(fit.vector.size)
    half[fit.free] = quantile(records, fit) * np.sqrt(
        np.diag(
            noise_covariance(records, fit)
            + inherited_covariance(records, fit)
            + misfit_covariance(records, fit)
        )
    )
    why = {one.name: _why(one, prior) for one in fixed}

    def parameter(entry: int, key: str) -> Estimate:
        value = float(getattr(point.machine, key))
        if key in why:
            return Estimate(value, None, why[key])
        reach = min(float(half[entry]), 700.0)
        return Estimate(value, (value * exp(-reach), value * exp(reach)))

    estimates = {key: parameter(entry, key) for entry, key in enumerate(PARAMETERS)}
    estimates["rotor_leakage_H"] = Estimate(
        point.machine.rotor_leakage_H,
        None,
        f"{prior.leakage_ratio:g} times the stator's: terminals tell only their sum",
    )
    found = tuple(
        _start_found(start, fit.residuals[k], point.starts[k], half[coordinates.first_of(k) :], k, why)
        for k, start in enumerate(records.starts)
    )
    deep_bars, saturation = point.change or (None, None)
    motor = Motor(
        plate.name,
        plate.nameplate,
        point.machine,
        plate.channels,
        plate.limits,
        plate.sensors,
        plate.transformers,
        ParametersSource.COMMISSIONED,
        start_limits=plate.start_limits,
        wound_rotor=plate.wound_rotor,
        thermal=plate.thermal,
        winding=plate.winding,
        deep_bars=deep_bars,
        leakage_saturation=saturation,
    )
    return Commissioning(
        motor=motor,
        parameters=estimates,
        change=_change(point, half, why),
        starts=tuple(_while_running(one, motor, records.load_law) for one in found),
        load_law=records.load_law.name.lower(),
        condition_number=condition,
        reasons=tuple(
            _reasons(estimates, found, prior, law_identified=law_identified, changes=coordinates.changes)
        ),
        warnings=tuple(_warnings(motor, estimates, found, records, fit.residuals)),
        evaluations=evaluations,
        compute_seconds=seconds,
    )


def _while_running(start: StartFound, motor: Motor, law: LoadLaw) -> StartFound:
    """Return a start whose load is the torque with which the motor then runs, as a diagnosis tells it.

    The fit takes the load at synchronous speed, from where a law of the speed leads to that of the slip.
    """
    plate, at_synchronous, share = motor.nameplate, start.load_level.value, 1.0
    for _ in range(RUNNING_STEPS if law else 0):
        crossing_W = at_synchronous * share * plate.rated_power_W
        at = load_point(motor, plate.winding_voltage_V, plate.rated_frequency_Hz, crossing_W)
        share = (1.0 - at.slip) ** law
    change = start.load_change
    return replace(
        start,
        load_level=_scaled(start.load_level, share),
        load_change=None if change is None else replace(change, change=_scaled(change.change, share)),
    )


def _scaled(estimate: Estimate, share: float) -> Estimate:
    ends = estimate.ci95
    scaled = None if ends is None else (share * ends[0], share * ends[1])
    return replace(estimate, value=share * estimate.value, ci95=scaled)


def _change(point: Point, half: Array, why: dict[str, str]) -> dict[str, Estimate]:
    """Return by how much the motor changes from a start to running, by name; nothing where it does not."""
    if point.change is None:
        return {}
    bars, saturation = point.change
    values = (*astuple(bars), *astuple(saturation))
    found = {}
    for entry, (name, value) in enumerate(zip(OF_A_CHANGE, values, strict=True), len(PARAMETERS)):
        reach = float(half[entry])
        is_logarithm = name in LOGARITHMS
        interval = (
            (value * exp(-reach), value * exp(reach)) if is_logarithm else (value - reach, value + reach)
        )
        found[name] = Estimate(value, None if name in why else interval, why.get(name))
    return found


def _warnings(
    motor: Motor,
    estimates: dict[str, Estimate],
    found: Sequence[StartFound],
    records: Records,
    residuals: Sequence[Array],
) -> list[str]:
    delays = [
        delay_warning(start, one.time_offset_s.value)
        for start, one in zip(records.starts, found, strict=True)
        if one.time_offset_s.fixed is None
    ]
    unusual = contradictions(motor, estimates, found, records.coordinates.prior)
    loads = [f"{one.record}: {in_words(one.load_change)}" for one in found if one.load_change is not None]
    return [
        *loads,
        *_unexplained(found, records.starts, residuals),
        *unusual,
        *(one for one in delays if one is not None),
    ]


def _unexplained(
    found: Sequence[StartFound], starts: Sequence[Start], residuals: Sequence[Array]
) -> Iterator[str]:
    """Yield a warning for each start of which the model leaves more than noise would."""
    for one, start, residual in zip(found, starts, residuals, strict=True):
        share = sqrt(misfit(start, residual) / float((start.measured_ab**2).sum()))
        if share > USUAL_MISFIT:
            yield (
                f"{one.record}: {share:.1%} of the current is left that noise does not explain: load or "
                "supply changed in another way than by one step or rise; the intervals allow for as much, "
                "and a start under a load that stays tells more"
            )


def _start_found(
    start: Start, residual: Array, own: Array, half: Array, number: int, why: dict[str, str]
) -> StartFound:

    def estimate(offset: int, unit: float) -> Estimate:
        value, reason = float(own[offset]), why.get(f"{OF_A_START[offset]}[{number}]")
        reach = float(half[offset]) * unit
        return Estimate(value, None if reason else (value - reach, value + reach), reason)

    rms = float(np.sqrt((residual**2).sum() / residual.shape[1]))
    measured = float(np.sqrt((start.measured_ab**2).sum() / residual.shape[1]))
    return StartFound(
        record=start.source,
        onset_s=start.onset_s,
        compared_s=start.compared_s,
        load_level=estimate(0, 1.0),
        time_offset_s=estimate(1, start.cycle_s),
        residual_rms_A=rms * start.line_per_winding_current,
        residual_share=rms / measured,
        load_change=found_load_change(start, own, half),
    )


def _why(one: Unidentifiable, prior: Prior) -> str:
    origin = "the motor file's value" if prior.from_file else "typical of the rating"
    taken = origin if one.name in PARAMETERS else "fixed at its usual value"
    if isinf(one.half_interval):
        return f"{taken}: beside the other fixed ones it would only make up for what they are off by"
    precision = "not at all" if one.half_interval > 10.0 else f"only within {one.half_interval:.0%}"
    together = f"; moves with {one.partner} (correlation {one.correlation:+.2f})" if one.partner else ""
    return f"{taken}: the record tells it {precision}{together}"


def _reasons(
    estimates: dict[str, Estimate],
    starts: Sequence[StartFound],
    prior: Prior,
    *,
    law_identified: bool,
    changes: bool,
) -> list[str]:
    reasons = []
    doubt = prior.doubt["stator_resistance_ohm"]
    identified = [key for key in PARAMETERS if estimates[key].fixed is None]
    if not identified:
        reasons.append(
            "not identifiable: the compared part of the record tells no parameter of the motor; a start from "
            "rest with its first half second does"
        )
    reasons += [f"{key}: {one.fixed}" for key, one in estimates.items() if one.fixed is not None]
    if identified and len(identified) < len(PARAMETERS):
        reasons.append(
            f"the other intervals allow for fixed values off by some {doubt:.0%} (inertia: twice that)"
        )
    for start in starts:
        for key, one in (("load_level", start.load_level), ("time_offset_s", start.time_offset_s)):
            if one.fixed is not None:
                reasons.append(f"{start.record}: {key}: {one.fixed}")
        if identified and start.residual_share > USUAL_RESIDUAL:
            reasons.append(
                f"{start.record}: {start.residual_share:.0%} of the current is left unexplained: noise, or a "
                "load or a supply that is another; the intervals do not cover a model that is wrong"
            )
    loads = [start.load_level for start in starts]
    if identified and not law_identified and any(one.fixed or abs(one.value) > LIGHT_LOAD for one in loads):
        reasons.append(
            "load law: the records do not tell how the load grows with speed; constant torque is assumed, on "
            "which inertia and load level depend"
        )
    if changes:
        reasons.append(
            "the motor changes from a start to running (deep bars, leakage that saturates): the parameters "
            "are those of running"
        )
    if not prior.from_file:
        reasons.append("the search began at values typical of the rating: the file has no [parameters]")
    return reasons
