"""What follows from the rotor's asymmetry in one record."""

from typing import TYPE_CHECKING, Final

from core.machines.parameters import MachineKind
from core.rotor.finding import LOAD_OSCILLATION, RotorState, decibels

if TYPE_CHECKING:  # pages know the limits and go without the compiler
    from core.rotor.asymmetry import Asymmetry

WATCH_DB, FAULT_DB = -42.0, -36.0
"""Severities: cages as they are made stay below the first. One open bar of 50 reaches the second; one of 28
has -30 dB."""
LEAST_LOAD_TORQUE = 0.005
"""Swing of the load that is told, over rated torque."""
CERTAIN_RATIO = 4.0
"""Load torque over its noise from which on there is one."""
LEAST_LOAD_SHARE = 0.5
"""Share of the load's torque in the torques of a ripple of the speed from which on the load makes it. An
asymmetry of the rotor needs none; an inertia that is wrong by a factor of two makes a third of it."""
UNEVEN_WINDING = "an uneven rotor winding"
"""So begins what is said of a wound rotor."""
FAULTY: Final = {
    MachineKind.CAGE: "broken bars or a broken end ring",
    MachineKind.WOUND_ROTOR: f"{UNEVEN_WINDING}: a bad contact of a brush, a slip ring or a joint in one "
    "phase, or an uneven resistance outside the motor",
}
"""What a faulty rotor of each kind has."""


def judge(
    found: "Asymmetry", kind: MachineKind, *, assumed: bool, typical: bool
) -> tuple[RotorState, list[str]]:
    """Judge the rotor's asymmetry.

    Parameters
    ----------
    found : "Asymmetry"
        The asymmetry.
    kind : MachineKind
        What the rotor is.
    assumed : bool
        Whether no voltages were recorded.
    typical : bool
        Whether nothing but the nameplate is known of the motor.

    Returns
    -------
    RotorState
        The state.
    list of str
        Its reasons.
    """
    state, reason = _state(found, kind)
    reasons = [reason]
    if state is RotorState.FAULT and (assumed or typical):
        state = RotorState.WATCH
        reasons.append(
            "no voltages recorded: a supply that pulsates would look the same"
            if assumed
            else "the motor's parameters are typical ones: the severity may be far off"
        )
    if _load_oscillates(found):
        reasons.append(
            f"{LOAD_OSCILLATION}: the load's torque swings by {found.load_torque:.1%} of the rated one at "
            "twice the slip and makes sidebands of its own, which are taken off"
        )
    return state, reasons


def _state(found: "Asymmetry", kind: MachineKind) -> tuple[RotorState, str]:
    low, high = (decibels(bound) for bound in found.interval)
    severity, limit = decibels(found.value), decibels(found.detection_limit)
    uneven = f"the rotor's resistance is uneven by {severity:.1f} dB (95 %: {low:.1f} to {high:.1f} dB)"
    if found.is_detected and low > FAULT_DB:
        return RotorState.FAULT, f"{uneven}, above {FAULT_DB:g} dB: {FAULTY[kind]}"
    if found.is_detected and severity > WATCH_DB:
        return (
            RotorState.WATCH,
            f"{uneven}, above {WATCH_DB:g} dB: compare it with earlier records at this load",
        )
    if limit > FAULT_DB:
        oscillates = found.leak > found.threshold / 2.0
        why = f"{LOAD_OSCILLATION} covers it" if oscillates else "noise, or a record too short for this slip"
        return RotorState.UNSUPPORTED, f"this record shows asymmetries above {limit:.1f} dB only: {why}"
    return RotorState.HEALTHY, f"no uneven rotor: this record would show {limit:.1f} dB"


def _load_oscillates(found: "Asymmetry") -> bool:
    makes = found.load_torque / (found.load_torque + found.inertia_torque + 1e-12)
    certain = found.load_torque > CERTAIN_RATIO * found.load_torque_noise
    return certain and found.load_torque > LEAST_LOAD_TORQUE and makes > LEAST_LOAD_SHARE
