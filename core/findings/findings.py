"""All that one record tells of its motor: one object from the worker to the row, and to who reads it."""

from collections.abc import Mapping
from dataclasses import dataclass

from core.classification.classification import Classification
from core.condition.observation import Observation
from core.diagnosis.verdict import Diagnosis
from core.losses.figures import LossFigures
from core.quantities import Subject
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.speed.finding import SpeedFinding
from core.starts.examined import ExaminedStart
from core.supply.figures import SupplyFigures


@dataclass(frozen=True, slots=True)
class Findings:
    """All that one record tells.

    Parameters
    ----------
    diagnosis : Diagnosis
        Its verdict, and what it shows of the stator.
    rotor : RotorFinding
        What it tells of the rotor's cage.
    eccentricity : EccentricityFinding
        What it tells of the air gap.
    pulsation : PulsationFinding
        What it tells of a load that swings.
    speed : SpeedFinding
        The speed of the shaft: seen in the current, or by the model.
    classification : Classification
        Which causes are likely, by all of these.
    losses : LossFigures
        What it tells of losses and efficiency.
    supply : SupplyFigures or None, optional
        What it shows of the supply; None where it shows nothing.
    observation : Observation or None, optional
        What it tells of the motor's condition; None where the quality gate refused it, no voltages are
        used, or its time is not known.
    start : ExaminedStart or None, optional
        What a start shows; None of other records, and where nothing can be measured.
    not_commissioned_from : str or None, optional
        Why the motor's parameters cannot be estimated from this start; None where they can, and for other
        records.
    duration_s : float or None, optional
        Length of the record [s].
    pre_trigger_s : float or None, optional
        How much of it is before its trigger; None where it names none [s].
    """

    diagnosis: Diagnosis
    rotor: RotorFinding
    eccentricity: EccentricityFinding
    pulsation: PulsationFinding
    speed: SpeedFinding
    classification: Classification
    losses: LossFigures
    supply: SupplyFigures | None = None
    observation: Observation | None = None
    start: ExaminedStart | None = None
    not_commissioned_from: str | None = None
    duration_s: float | None = None
    pre_trigger_s: float | None = None

    def beside_stator(self, *, of_rotor: bool = True) -> Mapping[Subject, object]:
        """Return what stands beside winding and cage, by subject.

        Parameters
        ----------
        of_rotor : bool, default True
            Whether the record could tell of the rotor, and so of air gap and load.

        Returns
        -------
        mapping of Subject to object
            The findings; without the supply and the losses where it shows no supply.
        """
        found: dict[Subject, object] = {}
        if of_rotor:
            found |= {Subject.AIR_GAP: self.eccentricity, Subject.LOAD: self.pulsation}
        if self.supply is not None:
            found |= {Subject.SUPPLY: self.supply, Subject.LOSSES: self.losses}
        return found

    def as_dict(self) -> dict[str, object]:
        """Return the document of the record, as `mcc diagnose --json` prints it; its keys are a contract.

        Returns
        -------
        dict of str to object
            The document of the diagnosis, with `rotor`, `supply`, `eccentricity`, `pulsation`, `speed`,
            `losses` and `classification`. Observation and start have documents of their own.
        """
        return self.diagnosis.as_dict() | {
            "rotor": self.rotor.as_dict(),
            "supply": None if self.supply is None else self.supply.as_dict(),
            "eccentricity": self.eccentricity.as_dict(),
            "pulsation": self.pulsation.as_dict(),
            "speed": self.speed.as_dict(),
            "losses": self.losses.as_dict(),
            "classification": self.classification.as_dict(),
        }
