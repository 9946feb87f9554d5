"""The rotor as one record shows it: what was measured, and what follows from it."""

from dataclasses import replace
from functools import partial

from core.diagnosis.acceptance import Accepted
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Motor
from core.machines.wound_rotor import resistance_at_rings_ohm, resistance_ratios
from core.rotor.asymmetry import FEWEST_TURNS_OF_ANY, measure_asymmetry
from core.rotor.baseband import Baseband
from core.rotor.finding import RotorFinding, decibels, load_bin
from core.rotor.judgement import judge
from core.rotor.running_point import running_point, slip_course, without_delay
from core.rotor.seen_slip import PLACED, at_seen_slip
from core.rotor.shorted_turns import without_shorted_turns
from core.rotor.sidebands import sideband_angle
from core.speed.finding import SpeedFinding

FEWEST_TURNS = 1.5
"""Least distance of the sidebands from the fundamental, in cycles of it over the record."""
FEWEST_TURNS_TOLD = 4.0
"""The same where the slip is unknown: a line nearer by may be the edge of one that is nearer still."""
LOWEST_SLIP, HIGHEST_SLIP = 1e-4, 0.2
HIGHEST_SLIP_AT_RINGS = 0.28
"""The same of a wound rotor with resistance at its rings; the sidebands keep away from the supply's line."""

SLIP_TOO_SMALL = (
    "the resistance at the slip rings is not known, and with the least of it the sidebands are too near the "
    "supply's line for this record: it takes a longer one, or more load"
)
SLIP_TOO_LARGE = (
    "the resistance at the slip rings is not known, and with the most of it the sidebands are too far from "
    "the supply's line: give a smaller external_resistance_ohm under [rotor_circuit], or record at less load"
)


def examine_rotor(
    recorded: Baseband, accepted: Accepted, diagnosis: Diagnosis, speed: SpeedFinding | None = None
) -> RotorFinding:
    """Tell from one record whether the rotor's cage has broken bars, or a wound rotor a bad contact.

    Parameters
    ----------
    recorded : Baseband
        The record's steady stretch, by `core.rotor.baseband.baseband_of`.
    accepted : Accepted
        The record, which passed the quality gate.
    diagnosis : Diagnosis
        Its diagnosis, which knows the sensors' delay, and the load beside shorted turns.
    speed : SpeedFinding or None, optional
        The record's speed; where it is seen in the current it places the sidebands, else the model does.

    Returns
    -------
    RotorFinding
        State, figures and reasons. A number of broken bars does not follow from them.
    """
    case, motor = accepted.case, accepted.case.motor
    duration_s = recorded.duration_s
    baseband = without_delay(recorded, motor, diagnosis.time_offset_s, assumed=case.voltages_assumed)
    if baseband is None:
        return _unsupported(duration_s, "the currents are not those of this motor at these voltages")
    at_ends: list[Baseband] = []
    fit, ends = diagnosis.fit, diagnosis.mu_f_ci95
    # Turns that cannot be excluded need not be there: what is taken off for them would pass for load.
    if diagnosis.verdict is Verdict.FAULT and fit is not None and ends is not None:
        at_ends = [without_shorted_turns(baseband, motor, replace(fit, mu_f=level)) for level in ends]
        baseband = without_shorted_turns(baseband, motor, fit)
    as_in_file, motor = motor, at_seen_slip(baseband, motor, speed)
    point = running_point(baseband, motor)
    slip, load_level = point.slip(motor), point.torque_Nm / motor.nameplate.rated_torque_Nm
    if diagnosis.phase is not None and diagnosis.load_level is not None:
        load_level = diagnosis.load_level  # of the power that crosses the air gap, shorted turns take a part
    ratios = resistance_ratios(motor)
    told_slip = None if ratios.are_open else slip
    unsupported = partial(_unsupported, duration_s, slip=told_slip, load_level=load_level)
    highest_slip = HIGHEST_SLIP if motor.wound_rotor is None else HIGHEST_SLIP_AT_RINGS
    if not LOWEST_SLIP < slip * ratios.least <= highest_slip:
        return unsupported(f"the slip of {slip:.2%} is not that of a motor that runs steadily under load")
    if 2.0 * slip * case.frequency_hz * duration_s < FEWEST_TURNS:
        return unsupported(_too_short(baseband, slip, case.frequency_hz))
    angle = sideband_angle(baseband, slip_course(baseband, motor, slip))
    found = measure_asymmetry(baseband, angle, motor, at_ends)
    state, reasons = judge(found, motor.kind, assumed=case.voltages_assumed, typical=motor.is_typical)
    if motor is not as_in_file:
        reasons.append(PLACED)
    if ratios.are_open:
        turns = 2.0 * slip * case.frequency_hz * duration_s
        if found.is_detected and turns * found.ratio >= FEWEST_TURNS_TOLD:
            told_slip = slip * found.ratio
            reasons.append(_told_of_rings(motor, found.ratio, told_slip))
        elif found.is_detected or turns * ratios.least < FEWEST_TURNS_OF_ANY:
            return unsupported(SLIP_TOO_SMALL)
        elif slip * ratios.most > highest_slip:
            return unsupported(SLIP_TOO_LARGE)
        else:
            reasons.append("the slip is not known: no sideband tells the resistance at the slip rings")
    return RotorFinding(
        state=state,
        lower_sideband_dB=decibels(found.lower),
        upper_sideband_dB=decibels(found.upper),
        severity_dB=decibels(found.value),
        severity_dB_ci95=(decibels(found.interval[0]), decibels(found.interval[1])),
        detection_limit_dB=decibels(found.detection_limit),
        slip=told_slip,
        load_level=load_level,
        load_bin=load_bin(load_level),
        duration_s=duration_s,
        load_oscillation_dB=decibels(found.load_torque),
        reasons=(*reasons, *_remarks(baseband)),
    )


def _told_of_rings(motor: Motor, ratio: float, slip: float) -> str:
    ohm = max(0.0, resistance_at_rings_ohm(motor, ratio))
    return (
        f"the sidebands tell a slip of {slip:.2%}, and with it {ohm:.3g} ohm a phase between the slip rings "
        "and their star point"
    )


def _too_short(baseband: Baseband, slip: float, frequency_hz: float) -> str:
    distance_hz = 2.0 * slip * frequency_hz
    length = f"{baseband.duration_s:.2f} s"
    steady = length if baseband.is_whole else f"the {length} of it in which the load is steady"
    return (
        f"the sidebands lie {distance_hz:.2f} Hz beside the supply's line, which this record ({steady}) does "
        f"not tell apart: it takes {FEWEST_TURNS / distance_hz:.1f} s, or more load"
    )


def _remarks(baseband: Baseband) -> list[str]:
    remarks = []
    if not baseband.is_whole:
        remarks.append(
            f"the last {baseband.duration_s:.1f} s are examined: before, the load or the voltage moves"
        )
    if baseband.spikes:
        remarks.append(f"{baseband.spikes} single samples beside the waveform were replaced")
    return remarks


def _unsupported(
    duration_s: float, reason: str, *, slip: float | None = None, load_level: float | None = None
) -> RotorFinding:
    return replace(
        RotorFinding.untold(reason, duration_s),
        slip=slip,
        load_level=load_level,
        load_bin=None if load_level is None else load_bin(load_level),
    )
