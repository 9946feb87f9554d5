"""Rotor and supply on the page of a recording, in words, from what its diagnosis kept."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.rotor.finding import RotorFinding, RotorState
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.supply.figures import SupplyFigures
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.client.rotor_and_supply import (
    gap_words,
    rotor_words,
    sideband_words,
    supply_words,
    swing_words,
)


@dataclass(frozen=True, slots=True)
class RotorShown:
    """What the page says of the rotor. gap, swings: what stands out of the air gap and of the load."""

    state: RotorState
    words: str
    sidebands: str | None
    finding: RotorFinding
    gap: str | None = None
    swings: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class SupplyShown:
    """What the page says of the supply."""

    words: Sequence[str]
    figures: SupplyFigures


def rotor_shown(diagnosis: Diagnosis | None) -> RotorShown | None:
    """Return what a diagnosis says of the rotor; None where it says nothing."""
    if diagnosis is None or diagnosis.rotor is None:
        return None
    fields = diagnosis.rotor.model_dump()
    finding = RotorFinding(**{**fields, "reasons": tuple(fields["reasons"])})
    gap, swings = None, []
    if diagnosis.eccentricity is not None and diagnosis.pulsation is not None:
        fields = diagnosis.eccentricity.model_dump()
        eccentricity = EccentricityFinding(**{**fields, "reasons": tuple(fields["reasons"])})
        fields = diagnosis.pulsation.model_dump()
        pulsation = PulsationFinding(**{**fields, "reasons": tuple(fields["reasons"])})
        gap, swings = gap_words(eccentricity), swing_words(eccentricity, pulsation)
    return RotorShown(finding.state, rotor_words(finding), sideband_words(finding), finding, gap, swings)


def supply_shown(diagnosis: Diagnosis | None) -> SupplyShown | None:
    """Return what a diagnosis says of the supply; None where its record shows nothing of it."""
    if diagnosis is None or diagnosis.supply is None:
        return None
    fields = diagnosis.supply.model_dump()
    lists = {name: tuple(value) for name, value in fields.items() if isinstance(value, list)}
    figures = SupplyFigures(**{**fields, **lists})
    return SupplyShown(supply_words(figures), figures)
