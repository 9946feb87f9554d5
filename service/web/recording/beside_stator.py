"""Rotor and supply on the page of a recording, in words, from what its diagnosis kept."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.rotor.finding import RotorFinding, RotorState
from core.supply.figures import SupplyFigures
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.client.losses import loss_words
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
    """What the page says of the supply, and of the losses."""

    words: Sequence[str]
    figures: SupplyFigures
    losses: Sequence[str] = ()


def rotor_shown(diagnosis: Diagnosis | None) -> RotorShown | None:
    """Return what a diagnosis says of the rotor; None where it says nothing."""
    if diagnosis is None or diagnosis.rotor is None:
        return None
    finding, gap, swings = diagnosis.rotor, None, []
    if diagnosis.eccentricity is not None and diagnosis.pulsation is not None:
        gap = gap_words(diagnosis.eccentricity)
        swings = swing_words(diagnosis.eccentricity, diagnosis.pulsation)
    return RotorShown(finding.state, rotor_words(finding), sideband_words(finding), finding, gap, swings)


def supply_shown(diagnosis: Diagnosis | None) -> SupplyShown | None:
    """Return what a diagnosis says of the supply; None where its record shows nothing of it."""
    if diagnosis is None or diagnosis.supply is None:
        return None
    losses = () if diagnosis.losses is None else tuple(loss_words(diagnosis.losses))
    return SupplyShown(supply_words(diagnosis.supply), diagnosis.supply, losses)
