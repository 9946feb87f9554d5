"""What a follower knows, as people and programs are told it."""

from math import sqrt
from typing import Final

import numpy as np

from core.machines.base import Array
from core.normal_distribution import NORMAL_95
from core.thermal.winding_temperature import COPPER_ZERO_C
from core.tracking.drift import FOLLOWED, possible_causes
from core.tracking.finding import ParameterName, TrackedParameter, TrackedParameters, TrackingState
from core.tracking.follower import REFERENCE_RECORDS, Follower
from core.tracking.record import LEAST_NOISE, distance_row
from core.tracking.unknowns import Unknown

WIDEST: Final = np.array([0.15, 0.03, 0.03, 0.15])
"""Half intervals of R_s, L_sigma, L_M and R_R above which they are not told."""
STANDING: Final = (Unknown.STATOR_RESISTANCE, Unknown.LEAKAGE, Unknown.MAGNETISING, Unknown.ROTOR_RESISTANCE)
LOADS: Final = (0.05, 0.25, 0.5, 0.75, 1.0)
"""Loads of which one is named that would tell what is not known."""
WARM_C: Final = 60.0
"""About the temperature of a winding in the first records [degree C]: it only scales a rise."""
SCALE_SPREAD: Final = 0.1
"""Half the interval of a rise's scale."""
NOTHING_LEFT: Final = -1.0
"""Change that leaves nothing of a parameter: no motor has one below, whatever happens to it."""
HELPS: Final = 0.9
"""Share of the interval that a record has to leave at most, to be worth naming."""


def tracked_parameters(follower: Follower) -> TrackedParameters:
    """Return what the records of a motor tell of its parameters.

    Parameters
    ----------
    follower : Follower
        The follower after the latest of them.

    Returns
    -------
    TrackedParameters
        Values, changes, intervals, states and possible causes.
    """
    told = {name: _parameter(follower, place) for place, name in enumerate(FOLLOWED)}
    states = [one.state for one in told.values()]
    if TrackingState.DRIFTING in states:
        state = TrackingState.DRIFTING
    else:
        state = TrackingState.STEADY if TrackingState.STEADY in states else TrackingState.UNDETERMINED
    drifting = [told[name].since_ns is not None for name in FOLLOWED]
    causes = possible_causes(*follower.changes, drifting)
    excess_K, interval_K = _winding_excess_K(follower)
    reasons = [f"{one.name.words} {_percent(one.change)}" for one in told.values() if one.change is not None]
    if causes:
        reasons.append(" or ".join(cause.words for cause in causes))
    if len(causes) > 1:
        reasons.append("the records do not tell these apart: records at other loads, or a start, may")
    return TrackedParameters(
        state=state,
        parameters=tuple(told[name] for name in ParameterName),
        records=follower.records,
        as_of_ns=follower.time_ns,
        reference_complete=follower.has_reference,
        winding_excess_K=excess_K,
        winding_excess_K_ci95=interval_K,
        causes=causes,
        reasons=tuple(reasons),
    )


def _parameter(follower: Follower, place: int) -> TrackedParameter:
    name, since_ns = FOLLOWED[place], follower.drifts[place].since_ns
    changes, covariance = follower.changes
    change, half = float(changes[place]), NORMAL_95 * sqrt(covariance[place, place])
    known = follower.has_reference and half <= WIDEST[place]
    reasons: tuple[str, ...] = ()
    if np.any(changes <= NOTHING_LEFT):
        state, since_ns, reasons = TrackingState.UNDETERMINED, None, (_impossible_reason(changes),)
    elif since_ns is not None:
        state, reasons = TrackingState.DRIFTING, (_drift_reason(change, half),)
    elif known:
        state = TrackingState.STEADY
    else:
        state, reasons = TrackingState.UNDETERMINED, _unknown_reasons(follower, place, half)
    told = state is not TrackingState.UNDETERMINED
    machine = follower.motor.parameters
    reference = {
        ParameterName.STATOR_RESISTANCE: machine.stator_resistance_ohm,
        ParameterName.ROTOR_RESISTANCE: machine.rotor_resistance_ohm,
        ParameterName.MAGNETISING_INDUCTANCE: machine.magnetising_inductance_H,
        ParameterName.LEAKAGE_INDUCTANCE: machine.stator_leakage_H + machine.rotor_leakage_H,
    }[name]
    return TrackedParameter(
        name=name,
        value=reference * (1.0 + change) if told else None,
        reference=reference,
        standing=float(follower.x[STANDING[place]]) if follower.has_reference else None,
        change=change if told else None,
        change_ci95=(change - half, change + half),
        state=state,
        since_ns=since_ns,
        reasons=reasons,
    )


def _impossible_reason(changes: Array) -> str:
    name = FOLLOWED[int(np.argmin(changes))]
    return (
        f"no motor explains the records: by them less than nothing would be left of the {name.words}; "
        "check the channels, their ratios and the motor file"
    )


def _drift_reason(change: float, half: float) -> str:
    return f"it has changed by {_percent(change)}, with an interval of {100.0 * half:.1f} % to either side"


def _unknown_reasons(follower: Follower, place: int, half: float) -> tuple[str, ...]:
    if not follower.has_reference:
        return (f"{follower.records} of the {REFERENCE_RECORDS} first records are there",)
    reasons = [f"a change is uncertain by {100.0 * half:.0f} % to either side"]
    if FOLLOWED[place] is ParameterName.ROTOR_RESISTANCE:
        varies = follower.unbalance_varies
        why = "varies too little beside the temperature" if varies else "does not vary"
        reasons.append(
            f"the current while running tells the rotor's resistance over the slip, whatever the load, and "
            f"the supply's unbalance {why}: a recorded start tells it"
        )
        return tuple(reasons)
    load = _telling_load(follower, place)
    if load is not None:
        reasons.append(f"a record at about {load:.0%} load would tell most")
    return tuple(reasons)


def _telling_load(follower: Follower, place: int) -> float | None:
    """Return the load at which one more record tells most of a parameter; None where none tells much."""
    at = Unknown.STATOR_RESISTANCE_CHANGE + place
    before = float(follower.P[at, at])
    left = {load: _variance_after(follower, at, load) / before for load in LOADS}
    best = min(left, key=lambda load: left[load])
    return best if left[best] <= HELPS**2 else None


def _variance_after(follower: Follower, at: int, load: float) -> float:
    """Return the variance of an unknown after a record at this load, rated voltage and frequency."""
    plate, rated = follower.motor.nameplate, follower.rated
    w = plate.rated_angular_frequency
    V = complex(w * rated.flux_Vs)
    current = V / rated.circuit.impedance(w, plate.base_impedance_ohm / load)
    h: Array = distance_row(V, current, w, rated, follower.x)[1]
    Ph = follower.P @ h
    noise = LEAST_NOISE**2 * follower.impedance_noise.factor
    return float(follower.P[at, at] - Ph[at] ** 2 / (float(h @ Ph) + noise))


def _winding_excess_K(follower: Follower) -> tuple[float | None, tuple[float, float] | None]:
    """Return how much hotter the winding is than its load explains, against the first records."""
    both = np.zeros(follower.x.size)
    both[[Unknown.STATOR_RESISTANCE_CHANGE, Unknown.WARMTH]] = 1.0
    half = NORMAL_95 * sqrt(float(both @ follower.P @ both))
    if not follower.has_reference or half > WIDEST[0]:
        return None, None
    kelvin = COPPER_ZERO_C + WARM_C
    excess_K = kelvin * float(both @ follower.x)
    half_K = sqrt((kelvin * half) ** 2 + (SCALE_SPREAD * excess_K) ** 2)
    return excess_K, (excess_K - half_K, excess_K + half_K)


def _percent(change: float | None) -> str:
    return "" if change is None else f"{100.0 * change:+.1f} %"
