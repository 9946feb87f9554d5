"""The rotor's cage as one record shows it: what was measured, and what follows from it."""

from functools import partial

from core.diagnosis.acceptance import Accepted
from core.diagnosis.verdict import Diagnosis
from core.rotor.asymmetry import measure_asymmetry
from core.rotor.baseband import Baseband, baseband_of
from core.rotor.finding import RotorFinding, RotorState, decibels, load_bin
from core.rotor.judgement import judge
from core.rotor.running_point import running_point, slip_course, without_delay
from core.rotor.sidebands import sideband_angle

FEWEST_TURNS = 1.5
"""Least distance of the sidebands from the fundamental, in cycles of it over the record."""
LOWEST_SLIP, HIGHEST_SLIP = 1e-4, 0.2


def examine_rotor(accepted: Accepted, diagnosis: Diagnosis) -> RotorFinding:
    """Tell from one record whether the rotor's cage has broken bars.

    Parameters
    ----------
    accepted : Accepted
        A record that passed the quality gate.
    diagnosis : Diagnosis
        Its diagnosis, which knows the sensors' delay.

    Returns
    -------
    RotorFinding
        State, figures and reasons. A number of broken bars does not follow from them.
    """
    case, motor = accepted.case, accepted.case.motor
    recorded = baseband_of(accepted)
    duration_s = recorded.duration_s
    baseband = without_delay(recorded, motor, diagnosis.time_offset_s, assumed=case.voltages_assumed)
    if baseband is None:
        return _unsupported(duration_s, "the currents are not those of this motor at these voltages")
    point = running_point(baseband, motor)
    slip, load_level = point.slip(motor), point.torque_Nm / motor.nameplate.rated_torque_Nm
    unsupported = partial(_unsupported, duration_s, slip=slip, load_level=load_level)
    if not LOWEST_SLIP < slip <= HIGHEST_SLIP:
        return unsupported(f"the slip of {slip:.2%} is not that of a motor that runs steadily under load")
    if 2.0 * slip * case.frequency_hz * duration_s < FEWEST_TURNS:
        return unsupported(_too_short(baseband, slip, case.frequency_hz))
    angle = sideband_angle(baseband, slip_course(baseband, motor, slip))
    found = measure_asymmetry(baseband, angle, motor)
    state, reasons = judge(found, assumed=case.voltages_assumed, typical=motor.is_typical)
    return RotorFinding(
        state=state,
        lower_sideband_dB=decibels(found.lower),
        upper_sideband_dB=decibels(found.upper),
        severity_dB=decibels(found.value),
        severity_dB_ci95=(decibels(found.interval[0]), decibels(found.interval[1])),
        detection_limit_dB=decibels(found.detection_limit),
        slip=slip,
        load_level=load_level,
        load_bin=load_bin(load_level),
        duration_s=duration_s,
        load_oscillation_dB=decibels(found.load_torque),
        reasons=(*reasons, *_remarks(baseband)),
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
    return RotorFinding(
        state=RotorState.UNSUPPORTED,
        lower_sideband_dB=None,
        upper_sideband_dB=None,
        severity_dB=None,
        severity_dB_ci95=None,
        detection_limit_dB=None,
        slip=slip,
        load_level=load_level,
        load_bin=None if load_level is None else load_bin(load_level),
        duration_s=duration_s,
        load_oscillation_dB=None,
        reasons=(reason,),
    )
