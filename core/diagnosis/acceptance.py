"""What a recording is, before anybody asks what it tells: its terminals, the quality gate, its phasors.

The diagnosis of a record and the observation of its motor's condition both begin here, so that a record is
read, checked and taken to phasors once.
"""

from dataclasses import dataclass, replace

import numpy as np

from core.diagnosis.case import LONGEST_RECORD_S, Case, case_of
from core.diagnosis.errors import NoVoltagesError
from core.diagnosis.fundamental import Fundamental, fundamental_of
from core.machines.parameters import Motor
from core.machines.wound_rotor import while_running
from core.operation import Operation
from core.quality import Passed, examine
from core.quality.finding import QualityFinding, all_passed, file_repair, file_warning, finding
from core.quality.operation import operation
from core.quality.stretches import CUT, longest_stretch
from core.quality.trip_signal import is_tripped
from core.recordings import Quantity, Recording
from core.signals.refusals import reasons
from core.signals.terminals import Terminals, terminals

LONGEST_START_S = 30.0
"""What the motor does is looked for in so much of a record, at its end: heavy fans take as long to start."""


@dataclass(frozen=True, slots=True)
class Accepted:
    """A record that passed the quality gate.

    Parameters
    ----------
    terminals : Terminals
        Quantities at the motor's terminals.
    case : Case
        The record in the winding frame.
    phasors : Fundamental
        Its phasors at supply frequency.
    recording : Recording
        The whole recording, of which the others hold only the end; of its channels only those that are used.
    """

    terminals: Terminals
    case: Case
    phasors: Fundamental
    recording: Recording


@dataclass(frozen=True, slots=True)
class Acceptance:
    """What the quality gate says of a record.

    Parameters
    ----------
    quality : tuple of QualityFinding
        Findings of all checks made.
    voltages_assumed : bool
        Whether no voltages were recorded, or none are used.
    accepted : Accepted or None
        The record; None where a check failed.
    operation : Operation or None, optional
        What the motor does in the whole recording; None where that cannot be told.
    """

    quality: tuple[QualityFinding, ...]
    voltages_assumed: bool
    accepted: Accepted | None
    operation: Operation | None = None


def accept(recording: Recording, motor: Motor, *, currents_only: bool = False) -> Acceptance:
    """Check a recording, bring it into the winding frame and find its phasors.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    currents_only : bool, default False
        Use no voltages, recorded or not; a balanced supply is assumed.

    Returns
    -------
    Acceptance
        Findings, and the record where it passed.

    Raises
    ------
    RecordingError
        If the recording lacks channels that the motor needs.
    """
    told = (*map(file_repair, recording.repairs), *map(file_warning, recording.warnings))
    try:
        acceptance = _accept(recording, motor, currents_only=currents_only)
    except (np.linalg.LinAlgError, ArithmeticError) as error:
        acceptance = Acceptance((not_computable(str(error)),), currents_only, None)
    return replace(acceptance, quality=(*told, *acceptance.quality))


def not_computable(what: str) -> QualityFinding:
    """Return the finding that the motor's equations give no figures."""
    return finding(
        "computability", 1, 0, "figures", passed=False,
        message=f"the motor's equations give no finite figures ({what}): nameplate and parameters, or the "
        "recording, are not those of a motor",
    )  # fmt: skip


def _accept(recording: Recording, motor: Motor, *, currents_only: bool) -> Acceptance:
    """Raise numpy.linalg.LinAlgError or ArithmeticError too, where no phasors can be computed."""
    used = _currents_of(recording) if currents_only else recording
    measured = terminals(
        used,
        currents=motor.channels.currents,
        phase_voltages=None if currents_only else motor.channels.phase_voltages,
        line_voltages=None if currents_only else motor.channels.line_voltages,
        longest_s=LONGEST_RECORD_S,
        voltage_ratio=motor.transformers.voltage_ratio,
        current_ratio=motor.transformers.current_ratio,
        inside_delta=motor.transformers.inside_delta,
    )
    assumed = measured.voltage_ab is None
    tripped = is_tripped(recording.digitals)
    if assumed and not currents_only:
        without = _without_voltages(measured, recording, motor, tripped=tripped)
        if without is not None:
            return without
        raise NoVoltagesError(
            recording.source,
            "voltages",
            expected="three phase voltages or two line voltages beside the currents",
            found=f"none: without them an unbalanced supply cannot be told from a fault. "
            f"{reasons(recording, Quantity.PHASE_VOLTAGE)}",
        )
    quality, passed = examine(measured, motor, tripped=tripped)
    does = _operation(recording, motor, quality, tripped=tripped)
    if passed is None and quality[-1].name in CUT:
        quality, measured, passed = _of_stretch(measured, motor, quality, tripped=tripped)
    if passed is None:
        return Acceptance(tuple(quality), assumed, None, does)
    rate, frequency = measured.sample_rate_hz, passed.frequency_hz
    running = while_running(motor)
    case = case_of(running, passed.current_abc, passed.voltage_ab, rate, frequency, passed.sequence)
    case = replace(case, voltages_assumed=assumed)
    return Acceptance(tuple(quality), assumed, Accepted(measured, case, fundamental_of(case), used), does)


def _of_stretch(
    measured: Terminals, motor: Motor, quality: list[QualityFinding], *, tripped: bool
) -> tuple[list[QualityFinding], Terminals, Passed | None]:
    """Examine the longest steady stretch of a record in which something happens, and tell what."""
    found = longest_stretch(measured, motor)
    if found is None:
        return quality, measured, None
    if isinstance(found, str):
        return [*quality[:-1], replace(quality[-1], message=found)], measured, None
    again, passed = examine(found.terminals, motor, tripped=tripped)
    if passed is None:
        event = f"{found.event}; {quality[-1].message}"
        return [*quality[:-1], replace(quality[-1], message=event)], measured, None
    return [*again, found.warning], found.terminals, passed


def _without_voltages(
    measured: Terminals, recording: Recording, motor: Motor, *, tripped: bool
) -> Acceptance | None:
    """Tell what a motor that does not run does, for which no voltages are needed; None for any other."""
    quality = [finding for finding in examine(measured, motor, tripped=tripped)[0] if not finding.passed]
    if not quality or quality[0].operation is None:
        return None
    does = _operation(recording, motor, quality, tripped=tripped)
    return Acceptance(tuple(quality), voltages_assumed=False, accepted=None, operation=does)


def _operation(
    recording: Recording, motor: Motor, quality: list[QualityFinding], *, tripped: bool
) -> Operation | None:
    """Return what the motor does in the whole recording, of which only the end is diagnosed."""
    found = list(quality)
    if recording.duration_s > LONGEST_RECORD_S:
        whole = terminals(
            recording,
            currents=motor.channels.currents,
            phase_voltages=motor.channels.phase_voltages,
            line_voltages=motor.channels.line_voltages,
            longest_s=LONGEST_START_S,
            voltage_ratio=motor.transformers.voltage_ratio,
            current_ratio=motor.transformers.current_ratio,
            inside_delta=motor.transformers.inside_delta,
        )
        if np.isfinite(whole.current_abc).all():
            found += operation(whole, motor, tripped=tripped)
    does = next((one.operation for one in found if one.operation is not None), None)
    if does is Operation.NOT_RUNNING:
        return does
    if tripped:
        return Operation.TRIP
    return Operation.RUNNING if does is None and all_passed(quality) else does


def _currents_of(recording: Recording) -> Recording:
    """Return the recording as if its voltages had not been recorded."""
    kept = [k for k, channel in enumerate(recording.channels) if channel.quantity is Quantity.CURRENT]
    return replace(
        recording, samples=recording.samples[kept], channels=tuple(recording.channels[k] for k in kept)
    )
