"""What a record tells, for tests that say of it only what they are about."""

from dataclasses import replace
from typing import Any

from core.classification.classification import classify
from core.classification.evidence import Evidence
from core.diagnosis.causes import PRIORS
from core.diagnosis.verdict import Diagnosis
from core.findings.findings import Findings
from core.losses.figures import LossFigures
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.speed.telling import not_seen

NOT_EXAMINED = "not examined"


def findings_of(diagnosis: Diagnosis, **parts: Any) -> Findings:
    """Return findings of a diagnosis, with these parts; those that are None, and the others, tell nothing."""
    untold = Findings(
        diagnosis=diagnosis,
        rotor=RotorFinding.untold(NOT_EXAMINED, 0.5),
        eccentricity=EccentricityFinding.untold(NOT_EXAMINED),
        pulsation=PulsationFinding.untold(NOT_EXAMINED),
        speed=not_seen(NOT_EXAMINED),
        losses=LossFigures.untold(NOT_EXAMINED),
        classification=classify(Evidence((), dict.fromkeys(PRIORS, NOT_EXAMINED))),
    )
    return replace(untold, **{name: part for name, part in parts.items() if part is not None})
