"""What the records of a motor tell of its parameters while it runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Self


class TrackingState(StrEnum):
    """How a parameter is."""

    STEADY = "steady"
    DRIFTING = "drifting"
    UNDETERMINED = "undetermined"
    """The records cannot tell; the reasons say why, and which record would."""


class ParameterName(StrEnum):
    """The parameters that are followed."""

    STATOR_RESISTANCE = "stator_resistance_ohm"
    ROTOR_RESISTANCE = "rotor_resistance_ohm"
    MAGNETISING_INDUCTANCE = "magnetising_inductance_H"
    LEAKAGE_INDUCTANCE = "leakage_inductance_H"

    @property
    def words(self) -> str:
        """The parameter in words."""
        return self.value.rpartition("_")[0].replace("_", " ")


class DriftCause(StrEnum):
    """What may have made parameters drift."""

    WINDING_HOT = "winding-hot"
    """Both resistances are higher than the load's heat explains: cooling, or a hot place."""
    RATIO = "ratio"
    """All impedances by one factor: a CT or VT ratio changed."""
    MAGNETISING = "magnetising"
    """The magnetising inductance alone: the iron or the air gap."""
    LEAKAGE = "leakage"
    """The leakage alone."""
    ROTOR = "rotor"
    """The rotor's resistance alone, beyond what its temperature explains: the cage gets worse."""

    @property
    def words(self) -> str:
        """The cause in words."""
        return _CAUSES[self]


_CAUSES = {
    DriftCause.WINDING_HOT: "the windings are hotter than their load explains",
    DriftCause.RATIO: "a CT or VT ratio changed",
    DriftCause.MAGNETISING: "the magnetising inductance changed",
    DriftCause.LEAKAGE: "the leakage inductance changed",
    DriftCause.ROTOR: "the cage has a higher resistance",
}


@dataclass(frozen=True, slots=True)
class TrackedParameter:
    """One parameter, at the temperature of the reference.

    Parameters
    ----------
    name : ParameterName
        Which one; the name has its unit.
    value : float or None
        Its value now: the reference times one plus the change. None where it is undetermined.
    reference : float
        The motor file's figure.
    standing : float or None
        By which fraction the first records differ from the file: errors of the file, of the sensors, and the
        temperature. It is taken out of the value. None where it is not known.
    change : float or None
        Change since the first records, a fraction.
    change_ci95 : tuple of float
        Its 95 % interval.
    state : TrackingState
        Steady, drifting or undetermined.
    since_ns : int or None
        Time of the record from which on it drifts, UTC [ns].
    reasons : tuple of str
        Reasons of the state in words.
    """

    name: ParameterName
    value: float | None
    reference: float
    standing: float | None
    change: float | None
    change_ci95: tuple[float, float]
    state: TrackingState
    since_ns: int | None
    reasons: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, object]:
        """Return the figures as JSON takes them.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        return {
            "name": str(self.name),
            "value": self.value,
            "reference": self.reference,
            "standing": self.standing,
            "change": self.change,
            "change_ci95": list(self.change_ci95),
            "state": str(self.state),
            "since_ns": self.since_ns,
            "reasons": list(self.reasons),
        }


@dataclass(frozen=True, slots=True)
class TrackedParameters:
    """The parameters of a motor as its records tell them.

    Parameters
    ----------
    state : TrackingState
        Drifting where any parameter drifts; undetermined where all are.
    parameters : tuple of TrackedParameter
        One each, in the order of `ParameterName`.
    records : int
        Number of records that they follow from.
    as_of_ns : int or None
        Time of the latest of them.
    reference_complete : bool
        Whether there are enough first records to compare with.
    winding_excess_K : float or None
        By how much the stator winding is hotter than its load explains, against the first records [K].
    winding_excess_K_ci95 : tuple of float or None
        Its 95 % interval [K].
    causes : tuple of DriftCause
        What may have made the parameters drift; several where the records do not tell them apart.
    reasons : tuple of str
        Reasons in words.
    """

    state: TrackingState
    parameters: tuple[TrackedParameter, ...]
    records: int
    as_of_ns: int | None
    reference_complete: bool
    winding_excess_K: float | None
    winding_excess_K_ci95: tuple[float, float] | None
    causes: tuple[DriftCause, ...]
    reasons: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the figures as JSON takes them.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        interval = self.winding_excess_K_ci95
        return {
            "state": str(self.state),
            "parameters": [one.as_dict() for one in self.parameters],
            "records": self.records,
            "as_of_ns": self.as_of_ns,
            "reference_complete": self.reference_complete,
            "winding_excess_K": self.winding_excess_K,
            "winding_excess_K_ci95": None if interval is None else list(interval),
            "causes": [str(one) for one in self.causes],
            "reasons": list(self.reasons),
        }

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> Self:
        """Return the finding that a document is of.

        Parameters
        ----------
        document : mapping of str to object
            What `as_dict` returned.

        Returns
        -------
        TrackedParameters
            The finding.
        """
        interval = document["winding_excess_K_ci95"]
        return cls(
            state=TrackingState(document["state"]),
            parameters=tuple(
                TrackedParameter(
                    **{
                        **one,
                        "name": ParameterName(one["name"]),
                        "state": TrackingState(one["state"]),
                        "change_ci95": tuple(one["change_ci95"]),
                        "reasons": tuple(one["reasons"]),
                    }
                )
                for one in document["parameters"]
            ),
            records=document["records"],
            as_of_ns=document["as_of_ns"],
            reference_complete=document["reference_complete"],
            winding_excess_K=document["winding_excess_K"],
            winding_excess_K_ci95=None if interval is None else tuple(interval),
            causes=tuple(DriftCause(one) for one in document["causes"]),
            reasons=tuple(document["reasons"]),
        )
