"""The answer of one record: evidence from all that was examined in it."""

from types import MappingProxyType
from typing import Final

from core.classification.amplitude import rotor_block
from core.classification.asymmetry import asymmetry_block
from core.classification.causes import PRIORS, Cause
from core.classification.classification import Classification, classify
from core.classification.evidence import Block, Evidence, Verdict, only
from core.classification.swings import eccentricity_block, pulsation_block
from core.condition.errors import ObservationError
from core.condition.measuring.observing import Examined
from core.diagnosis.verdict import Diagnosis
from core.diagnosis.verdict import Verdict as DiagnosisVerdict
from core.machines.parameters import Motor
from core.rotor.finding import RotorState

REFUSED: Final = 8.0
"""Evidence of a check of the quality gate that failed [nats]: it names what is wrong, not how surely."""
CHECKS: Final = MappingProxyType(
    {
        "current polarity": Cause.CURRENT_CHANNEL,
        "current sum": Cause.CURRENT_CHANNEL,
        "saturation": Cause.CURRENT_CHANNEL,
        "voltage loss": Cause.VOLTAGE_CHANNEL,
        "voltage polarity": Cause.VOLTAGE_CHANNEL,
        "voltage ratio": Cause.VOLTAGE_CHANNEL,
        "voltage unbalance": Cause.VOLTAGE_CHANNEL,
        "identifiability": Cause.PARAMETERS,
        "computability": Cause.PARAMETERS,
    }
)
"""What a check of the quality gate that fails is a sign of."""
ONE_RECORD: Final = "one record does not tell what the load was before"


def classify_record(examined: Examined, motor: Motor) -> Classification:
    """Weigh the causes by all that one record shows.

    Parameters
    ----------
    examined : Examined
        What was examined in the record.
    motor : Motor
        The motor, with tolerances and the class of its sensors.

    Returns
    -------
    Classification
        The answer.
    """
    return classify(evidence_of(examined, motor))


def evidence_of(examined: Examined, motor: Motor) -> Evidence:
    """Return the evidence of one record.

    Parameters
    ----------
    examined : Examined
        What was examined in the record.
    motor : Motor
        The motor.

    Returns
    -------
    Evidence
        Its blocks, and why nothing is known of the other causes.
    """
    rotor, eccentricity, pulsation = examined.rotor, examined.eccentricity, examined.pulsation
    blocks: list[Block | None] = [
        rotor_block(rotor.severity_dB, rotor.severity_dB_ci95),
        eccentricity_block(eccentricity),
        pulsation_block(rotor, eccentricity, pulsation),
    ]
    stator, why = _of_phasors(examined, motor)
    known = tuple(block for block in (*blocks, stator) if block is not None)
    told = frozenset().union(*(block.causes for block in known)) if known else frozenset()
    reasons = {
        Cause.ROTOR: _first(rotor.reasons),
        Cause.ECCENTRICITY: _first(eccentricity.reasons),
        Cause.PULSATION: _first(pulsation.reasons),
        Cause.LOAD: ONE_RECORD,
    }
    untold = {cause: reasons.get(cause, why) for cause in PRIORS if cause not in told}
    return Evidence(known, untold, _verdicts(examined))


def _of_phasors(examined: Examined, motor: Motor) -> tuple[Block | None, str]:
    """Return the evidence of phasors or of the quality gate; or why there is none."""
    diagnosis = examined.diagnosis
    refused = _refused(diagnosis)
    if refused is not None:
        return refused, "the quality gate refused the record"
    if examined.observation is None:
        return None, _why_no_phasors(diagnosis)
    try:
        return asymmetry_block(examined.observation, motor), ""
    except ObservationError as error:
        return None, str(error)


def _refused(diagnosis: Diagnosis) -> Block | None:
    failed = next((one for one in diagnosis.quality if not one.passed), None)
    cause = None if failed is None else CHECKS.get(failed.name)
    if failed is None or cause is None:
        return None
    return only(cause, REFUSED, failed.message)


def _why_no_phasors(diagnosis: Diagnosis) -> str:
    if diagnosis.verdict is DiagnosisVerdict.UNDIAGNOSABLE:
        return "the quality gate refused the record"
    if diagnosis.currents_only:
        return "without voltages a fault, a channel and the supply look alike"
    return "the record tells no time, and no phasors are kept of it"


def _verdicts(examined: Examined) -> tuple[Verdict, ...]:
    """Return what the record's own verdicts say for sure."""
    diagnosis, rotor = examined.diagnosis, examined.rotor
    turns, cage = Cause.SHORTED_TURNS, Cause.ROTOR
    found = []
    if diagnosis.verdict is DiagnosisVerdict.FAULT:
        words = f"fault, shorted turns in phase {diagnosis.phase}"
        found.append(Verdict(turns, is_there=True, words=words))
    if diagnosis.verdict is DiagnosisVerdict.HEALTHY:
        found.append(Verdict(turns, is_there=False, words="no shorted turns"))
    if rotor.state is RotorState.FAULT:
        found.append(Verdict(cage, is_there=True, words="fault of the rotor"))
    if rotor.state is RotorState.HEALTHY:
        found.append(Verdict(cage, is_there=False, words="an even rotor"))
    return tuple(found)


def _first(reasons: tuple[str, ...]) -> str:
    return reasons[0] if reasons else "no figures"
