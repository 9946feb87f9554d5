"""The answer of one record: evidence from all that was examined in it."""

from types import MappingProxyType
from typing import Final

from core.classification.amplitude import log_ratio, rotor_block
from core.classification.classification import Classification, classify
from core.classification.evidence import Block, Evidence, Verdict, only
from core.classification.swings import eccentricity_block, pulsation_block
from core.diagnosis.causes import OF_ONE_ASYMMETRY, PRIORS, Cause
from core.diagnosis.phase_words import turns_phase_in_words
from core.diagnosis.verdict import Diagnosis
from core.diagnosis.verdict import Verdict as DiagnosisVerdict
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding

REFUSED: Final = 8.0
"""Evidence of a check of the quality gate that failed [nats]: it names what is wrong, not how surely."""
MEASURED_UNBALANCE: Final = 0.002
"""Standard deviation of V2/V1 by the voltage channels (complex magnitude)."""
BALANCED, UNBALANCED = 0.007, 0.028
"""V2/V1 of usual supplies, rms, and of unbalanced ones."""
CHECKS: Final = MappingProxyType(
    {
        "current polarity": Cause.CURRENT_CHANNEL,
        "current sum": Cause.CURRENT_CHANNEL,
        "saturation": Cause.CURRENT_CHANNEL,
        "voltage loss": Cause.VOLTAGE_CHANNEL,
        "voltage polarity": Cause.VOLTAGE_CHANNEL,
        "voltage ratio": Cause.VOLTAGE_CHANNEL,
        "voltage unbalance": Cause.VOLTAGE_CHANNEL,
        "connection": Cause.PARAMETERS,
        "identifiability": Cause.PARAMETERS,
        "computability": Cause.PARAMETERS,
    }
)
"""What a check of the quality gate that fails is a sign of."""
ONE_RECORD: Final = "one record does not tell what the load was before"


def classify_record(
    diagnosis: Diagnosis, rotor: RotorFinding, eccentricity: EccentricityFinding, pulsation: PulsationFinding
) -> Classification:
    """Weigh the causes by all that one record shows.

    Parameters
    ----------
    diagnosis : Diagnosis
        What it shows of the stator.
    rotor : RotorFinding
        What it shows of the rotor's cage.
    eccentricity : EccentricityFinding
        What it shows of the air gap.
    pulsation : PulsationFinding
        What it shows of a load that swings.

    Returns
    -------
    Classification
        The answer.
    """
    blocks: list[Block | None] = [
        rotor_block(rotor.severity_dB, rotor.severity_dB_ci95),
        eccentricity_block(eccentricity),
        pulsation_block(rotor, eccentricity, pulsation),
    ]
    stator, why = _of_phasors(diagnosis)
    known = tuple(block for block in (*blocks, stator, _supply(diagnosis)) if block is not None)
    told = frozenset().union(*(block.causes for block in known)) if known else frozenset()
    reasons = {
        Cause.ROTOR: _first(rotor.reasons),
        Cause.ECCENTRICITY: _first(eccentricity.reasons),
        Cause.PULSATION: _first(pulsation.reasons),
        Cause.LOAD: ONE_RECORD,
    }
    untold = {cause: reasons.get(cause, why) for cause in PRIORS if cause not in told}
    return classify(Evidence(known, untold, _verdicts(diagnosis, rotor), OF_ONE_ASYMMETRY))


def _of_phasors(diagnosis: Diagnosis) -> tuple[Block | None, str]:
    """Return the evidence of the stator or of the quality gate; or why there is none."""
    refused = _refused(diagnosis)
    if refused is not None:
        return refused, "the quality gate refused the record"
    if diagnosis.currents_only:
        return None, "without voltages a fault, a channel and the supply look alike"
    if not diagnosis.hypotheses:
        return None, "the quality gate refused the record"
    ratios = {one.cause: one.log_likelihood_ratio for one in diagnosis.hypotheses}
    figures = {one.cause: one.figure for one in diagnosis.hypotheses}
    causes = frozenset(ratios) - {Cause.HEALTHY}
    likelihood = {frozenset({one}): ratios[one] for one in causes}
    return Block(causes, likelihood, {one: figures[one] for one in causes}), ""


def _supply(diagnosis: Diagnosis) -> Block | None:
    """Return the evidence of an unbalanced supply: how far V2/V1 is beyond that of usual ones."""
    indicators = diagnosis.indicators
    if indicators is None or diagnosis.currents_only:
        return None
    unbalance = indicators.voltage_unbalance
    return only(
        Cause.SUPPLY,
        log_ratio(unbalance, MEASURED_UNBALANCE, BALANCED, (UNBALANCED,)),
        f"V2/V1 is {unbalance:.1%}",
    )


def _refused(diagnosis: Diagnosis) -> Block | None:
    failed = next((one for one in diagnosis.quality if not one.passed), None)
    cause = None if failed is None else CHECKS.get(failed.name)
    if failed is None or cause is None:
        return None
    return only(cause, REFUSED, failed.message)


def _verdicts(diagnosis: Diagnosis, rotor: RotorFinding) -> tuple[Verdict, ...]:
    """Return what the record's own verdicts say for sure."""
    turns, cage = Cause.SHORTED_TURNS, Cause.ROTOR
    found = []
    if diagnosis.verdict is DiagnosisVerdict.FAULT:
        phase = turns_phase_in_words(diagnosis.as_dict())
        words = f"fault, shorted turns in phase {phase}" if phase else "fault, shorted turns"
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
