"""All that one record tells: its own diagnosis, an observation of its motor's condition, rotor and supply."""

from hashlib import sha256
from math import isfinite, sqrt

import numpy as np

from core.condition.measuring.bounds import LONGEST_RECORDER
from core.condition.measuring.impedance import negative_impedance
from core.condition.observation import Observation, VoltageChannels
from core.diagnosis.acceptance import Accepted, accept
from core.diagnosis.errors import NoVoltagesError
from core.diagnosis.fundamental import Fundamental, phasors_of
from core.diagnosis.operating_point import load_of
from core.machines.parameters import Motor
from core.recordings import Channel, Quantity, Recording

PHASE_PER_SPACE_VECTOR = sqrt(2.0 / 3.0)
"""Phasor of a phase over that of the power-invariant space vector."""


def observe(recording: Recording, motor: Motor) -> Observation | None:
    """Observe the motor's condition in one record, without a diagnosis.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        Nameplate, parameters and channel names of the motor.

    Returns
    -------
    Observation or None
        The observation; None where the quality gate refuses the record, or it has no voltages.

    Raises
    ------
    RecordingError
        If the recording lacks currents that the motor needs, or channels are ambiguous.
    """
    try:
        accepted = accept(recording, motor).accepted
    except NoVoltagesError:
        return None
    return None if accepted is None else observation_of(recording, accepted)


def observation_of(recording: Recording, accepted: Accepted) -> Observation | None:
    """Take the observation from a record that passed the quality gate.

    Parameters
    ----------
    recording : Recording
        The recording, for its time and its recorder.
    accepted : Accepted
        The record in the winding frame, with its phasors.

    Returns
    -------
    Observation or None
        The observation; None where no voltages are used, or the motor has no finite impedance.
    """
    terminals, case, record = accepted.terminals, accepted.case, accepted.phasors
    voltages = _voltage_channels(accepted)
    impedance = negative_impedance(case.motor, case.frequency_hz)
    scatter = _scatter(record, impedance)
    if voltages is None or not isfinite(scatter):
        return None
    zero = [terminals.current_abc.mean(axis=0)]
    if voltages is VoltageChannels.PHASE:
        zero.append(terminals.voltages.mean(axis=0))
    zero_current, *zero_voltage = phasors_of(np.stack(zero), case)
    forward = record.voltage.forward
    turned = forward.conjugate() / abs(forward)
    winding = PHASE_PER_SPACE_VECTOR * turned
    return Observation(
        time_ns=recording.trigger_time_ns,
        recorder=recorder_of(recording, (*terminals.current_channels, *terminals.voltage_channels)),
        sequence=case.sequence,
        voltage_channels=voltages,
        frequency_hz=case.frequency_hz,
        positive_voltage_V=winding * forward,
        negative_voltage_V=winding * record.voltage.backward.conjugate(),
        zero_voltage_V=turned * complex(zero_voltage[0]) if zero_voltage else None,
        positive_current_A=winding * record.current.forward,
        negative_current_A=winding * record.current.backward.conjugate(),
        zero_current_A=turned * complex(zero_current),
        scatter=scatter,
        cycles=record.cycles,
        load_level=load_of(record, case.motor),
    )


def recorder_of(recording: Recording, channels: tuple[Channel, ...]) -> str:
    """Name what measured: station and device of the record, and its channels with their transformers' ratios.

    Parameters
    ----------
    recording : Recording
        The recording.
    channels : tuple of Channel
        The channels that were used.

    Returns
    -------
    str
        The name. A long one is cut and ends with a digest of the whole.
    """
    place = "/".join(word for word in (recording.station, recording.device) if word)
    ratios = [
        channel.name + ("" if channel.transformer_ratio is None else f" {channel.transformer_ratio:.6g}:1")
        for channel in channels
    ]
    name = ", ".join([*([place] if place else []), *ratios])
    if len(name) <= LONGEST_RECORDER:
        return name
    digest = sha256(name.encode(errors="surrogatepass")).hexdigest()[:16]
    return f"{name[: LONGEST_RECORDER - len(digest) - 1]} {digest}"


def _voltage_channels(accepted: Accepted) -> VoltageChannels | None:
    quantity, count = accepted.terminals.voltage_quantity, len(accepted.terminals.voltage_channels)
    if quantity is None:
        return None
    if quantity is Quantity.PHASE_VOLTAGE:
        return VoltageChannels.PHASE
    return VoltageChannels.THREE_LINES if count == 3 else VoltageChannels.TWO_LINES


def _scatter(record: Fundamental, impedance: complex) -> float:
    """Variance of y = (V2 - Z2 I2) / V1, from what single cycles have beside the record's phasors.

    What voltage and current have in common, as where the supply's unbalance wanders, cancels in y.
    """
    voltage, current, forward = record.voltage, record.current, record.voltage.forward
    y = (voltage.backward.conjugate() - impedance * current.backward.conjugate()) / forward
    backward = voltage.by_cycle[1].conj() - impedance * current.by_cycle[1].conj()
    return record.variance((backward - y * voltage.by_cycle[0]) / forward)
