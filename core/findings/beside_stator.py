"""Rotor, supply and load of a record, beside its stator: no error of theirs takes the diagnosis away."""

from core.diagnosis.acceptance import Acceptance, Accepted
from core.diagnosis.verdict import Diagnosis, not_finite
from core.findings.seen_speed import speed_of
from core.losses.figures import LossFigures
from core.losses.measuring import measure_losses
from core.machines.parameters import Motor
from core.operation import Operation
from core.recordings import Recording, RecordingError
from core.rotor.baseband import Baseband, baseband_of
from core.rotor.eccentricity import examine_eccentricity
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.pulsation import examine_pulsation
from core.rotor.running_point import without_delay
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.speed.finding import SpeedFinding
from core.speed.memory import LineMemory
from core.speed.telling import not_seen
from core.supply.figures import SupplyFigures
from core.supply.measuring import measure_supply

NO_ROTOR = "the figures of the rotor cannot be computed"
NO_SPEED = "the speed cannot be computed"
NO_LOSSES = "the losses cannot be computed"
NO_SWINGS = "the figures of the swings cannot be computed"
_NOT_COMPUTABLE = (ValueError, ArithmeticError)
"""Errors of figures; SignalError and numpy's LinAlgError are among them."""


def rotor_and_swings_of(
    recording: Recording,
    accepted: Accepted | None,
    diagnosis: Diagnosis,
    speed: SpeedFinding | None = None,
) -> tuple[RotorFinding, EccentricityFinding, PulsationFinding]:
    """Tell what a record shows of the rotor, of the air gap and of a load that swings.

    All of them look at the same space vectors in the frame of the supply, which are taken once.

    Parameters
    ----------
    recording : Recording
        The recording.
    accepted : Accepted or None
        The record after the quality gate; None where it was refused.
    diagnosis : Diagnosis
        Its diagnosis.
    speed : SpeedFinding or None, optional
        Its speed.

    Returns
    -------
    RotorFinding
        What it tells of the rotor's cage. Where the record was refused, or its figures cannot be computed,
        its state is unsupported and its reasons say why.
    EccentricityFinding
        What it tells of the air gap; its reasons say why it tells nothing.
    PulsationFinding
        What it tells of the load, likewise.
    """
    if accepted is None:
        refused = "the quality gate refused the record"
        return RotorFinding.untold(refused, recording.duration_s), *_nothing_of_swings(refused)
    try:
        recorded = baseband_of(accepted)
    except _NOT_COMPUTABLE as error:
        return (
            RotorFinding.untold(f"{NO_ROTOR}: {error}", recording.duration_s),
            *_nothing_of_swings(f"{NO_SWINGS}: {error}"),
        )
    rotor = _rotor(recording, recorded, accepted, diagnosis, speed)
    return rotor, *_swings(recorded, accepted, diagnosis, rotor)


def _rotor(
    recording: Recording,
    recorded: Baseband,
    accepted: Accepted,
    diagnosis: Diagnosis,
    speed: SpeedFinding | None,
) -> RotorFinding:
    try:
        finding = examine_rotor(recorded, accepted, diagnosis, speed)
    except _NOT_COMPUTABLE as error:
        return RotorFinding.untold(f"{NO_ROTOR}: {error}", recording.duration_s)
    impossible = not_finite(finding.as_dict())
    if impossible is None:
        return finding
    return RotorFinding.untold(f"{NO_ROTOR}: {impossible} is not finite", recording.duration_s)


def _swings(
    recorded: Baseband, accepted: Accepted, diagnosis: Diagnosis, rotor: RotorFinding
) -> tuple[EccentricityFinding, PulsationFinding]:
    case = accepted.case
    if case.voltages_assumed:
        return _nothing_of_swings("no voltages recorded: a supply that pulsates would look the same")
    try:
        baseband = without_delay(recorded, case.motor, diagnosis.time_offset_s, assumed=False)
        if baseband is None:
            return _nothing_of_swings("the currents are not those of this motor at these voltages")
        even_rotor = rotor.state is RotorState.HEALTHY
        eccentricity = examine_eccentricity(baseband, case.motor)
        pulsation = examine_pulsation(baseband, case.motor, even_rotor=even_rotor)
    except _NOT_COMPUTABLE as error:
        return _nothing_of_swings(f"{NO_SWINGS}: {error}")
    impossible = not_finite([eccentricity.as_dict(), pulsation.as_dict()])
    if impossible is None:
        return eccentricity, pulsation
    return _nothing_of_swings(f"{NO_SWINGS}: {impossible} is not finite")


def _nothing_of_swings(reason: str) -> tuple[EccentricityFinding, PulsationFinding]:
    return EccentricityFinding.untold(reason), PulsationFinding.untold(reason)


def speed_beside(accepted: Accepted | None, diagnosis: Diagnosis, memory: LineMemory | None) -> SpeedFinding:
    """Tell the speed of a record; where its figures cannot be computed, a reason says so.

    Parameters
    ----------
    accepted : Accepted or None
        The record after the quality gate; None where it was refused.
    diagnosis : Diagnosis
        Its diagnosis.
    memory : LineMemory or None
        What earlier records told of the motor's lines.

    Returns
    -------
    SpeedFinding
        The speed.
    """
    if accepted is None:
        return not_seen("the quality gate refused the record")
    try:
        finding = speed_of(accepted, diagnosis, memory)
    except _NOT_COMPUTABLE as error:
        return not_seen(f"{NO_SPEED}: {error}")
    impossible = not_finite(finding.as_dict())
    return finding if impossible is None else not_seen(f"{NO_SPEED}: {impossible} is not finite")


def supply_of(
    recording: Recording, motor: Motor, acceptance: Acceptance
) -> tuple[SupplyFigures | None, str | None]:
    """Measure the supply where a motor runs or stands.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        Nameplate, channel names and ratios of the motor.
    acceptance : Acceptance
        What the quality gate says of the record.

    Returns
    -------
    SupplyFigures or None
        The figures; None where the record has no voltages, shows no steady supply, or they cannot be
        computed.
    str or None
        Why they cannot be computed.
    """
    if acceptance.accepted is None and acceptance.operation is not Operation.NOT_RUNNING:
        return None, None
    accepted = acceptance.accepted
    frequency_hz = None if accepted is None else accepted.case.frequency_hz
    try:
        figures = measure_supply(recording, motor, frequency_hz=frequency_hz)
    except RecordingError:
        return None, None
    except _NOT_COMPUTABLE as error:
        return None, f"the figures of the supply cannot be computed: {error}"
    impossible = not_finite(figures.as_dict())
    if impossible is None:
        return figures, None
    return None, f"the figures of the supply cannot be computed: {impossible} is not finite"


def losses_of(
    motor: Motor,
    diagnosis: Diagnosis,
    supply: SupplyFigures | None,
    rotor: RotorFinding,
    speed: SpeedFinding,
) -> LossFigures:
    """Tell the losses of the motor; where they cannot be computed, a reason says so."""
    try:
        figures = measure_losses(motor, diagnosis, supply, rotor, speed)
    except _NOT_COMPUTABLE as error:
        return LossFigures.untold(f"{NO_LOSSES}: {error}")
    impossible = not_finite(figures.as_dict())
    return figures if impossible is None else LossFigures.untold(f"{NO_LOSSES}: {impossible} is not finite")
