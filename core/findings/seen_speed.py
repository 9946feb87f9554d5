"""The speed of a record that passed the quality gate: seen in its currents, or by the model."""

import numpy as np

from core.diagnosis.acceptance import Accepted
from core.diagnosis.verdict import Diagnosis
from core.machines.parameters import MachineKind
from core.signals.clarke import clarke
from core.signals.terminals import terminals
from core.speed.finding import SpeedFinding
from core.speed.memory import LineMemory
from core.speed.record import LONGEST_S, speed_record, why_unsuited
from core.speed.telling import learn, not_seen, tell_speed

BARS_UNKNOWN = (
    "the number of rotor bars is not known: give rotor_bars in the motor file, or have it learnt from "
    "records of the motor in the order of time"
)


def speed_of(accepted: Accepted, diagnosis: Diagnosis, memory: LineMemory | None = None) -> SpeedFinding:
    """Tell the speed of the shaft in a record.

    Parameters
    ----------
    accepted : Accepted
        The record.
    diagnosis : Diagnosis
        Its diagnosis, which has the speed of the model.
    memory : LineMemory or None, optional
        What earlier records told of the motor's lines; it learns from this one. None where there are no
        earlier ones: the number of bars has to be in the motor's file then.

    Returns
    -------
    SpeedFinding
        The speed, its interval and where it comes from.
    """
    case, motor = accepted.case, accepted.case.motor
    pole_pairs, frequency_hz = motor.nameplate.pole_pairs, case.frequency_hz
    model_slip = None
    if diagnosis.speed_rpm is not None:
        model_slip = 1.0 - pole_pairs * diagnosis.speed_rpm / (60.0 * frequency_hz)

    def without(reason: str) -> SpeedFinding:
        return not_seen(reason, model_slip, diagnosis.speed_rpm)

    if motor.kind is not MachineKind.CAGE:
        return without("the speed is looked for in the currents of motors with a cage")
    bars = motor.nameplate.rotor_bars
    if memory is None and bars is None:
        return without(BARS_UNKNOWN)
    lines = LineMemory(bars) if memory is None else memory
    current_abc = terminals(
        accepted.recording,
        currents=motor.channels.currents,
        longest_s=LONGEST_S,
        current_ratio=motor.transformers.current_ratio,
    ).current_abc
    missing = np.flatnonzero(~np.isfinite(current_abc).all(axis=0))
    current_abc = current_abc[:, int(missing[-1]) + 1 :] if missing.size else current_abc
    unsuited = why_unsuited(current_abc.shape[1], case.sample_rate_hz)
    if unsuited is not None:
        return without(unsuited)
    record = speed_record(clarke(current_abc), case.sample_rate_hz, frequency_hz, pole_pairs)
    finding = tell_speed(record, lines, model_slip=model_slip, is_model_sure=not motor.is_typical)
    if memory is not None:
        learn(record, finding, memory)
    return finding
