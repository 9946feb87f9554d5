"""What the answer of a motor needs of the answers of its records."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from core.diagnosis.causes import OF_ONE_ASYMMETRY, Cause, Causes


@dataclass(frozen=True, slots=True)
class RecordAnswer:
    """What the answer of one record keeps for that of its motor.

    Parameters
    ----------
    log_likelihood_ratios : mapping of Cause to float
        Of each cause alone; those that the record tells [nats].
    figures : mapping of Cause to str
        What was measured of each, in words.
    """

    log_likelihood_ratios: Mapping[Cause, float]
    figures: Mapping[Cause, str]

    @classmethod
    def from_dict(cls, document: Mapping[str, object]) -> "RecordAnswer":
        """Return what the document of a record's answer keeps.

        Parameters
        ----------
        document : mapping
            What `Classification.as_dict` returned.

        Returns
        -------
        RecordAnswer
            What it keeps.

        Raises
        ------
        KeyError, TypeError, ValueError
            If it is no such document.
        """
        likelihoods = _list_of(document["likelihoods"], "likelihoods")
        told = [one for one in likelihoods if one["log_likelihood_ratio"] is not None]
        return cls(
            {Cause(one["cause"]): float(one["log_likelihood_ratio"]) for one in told},
            {Cause(one["cause"]): str(one["figure"]) for one in told},
        )

    def of_both(self, one: Cause, other: Cause) -> float:
        """Return the evidence for two causes that the record tells, together.

        Parameters
        ----------
        one, other : Cause
            The causes.

        Returns
        -------
        float
            Log of the likelihood ratio to none of them [nats]; their sum where they show in other figures.
        """
        ratios = self.log_likelihood_ratios
        if {one, other} <= OF_ONE_ASYMMETRY:
            return max(ratios[one], ratios[other])
        return ratios[one] + ratios[other]

    def beside(self, cause: Cause, changes: Causes) -> float | None:
        """Return the evidence for a cause where one of some changes is there anyway.

        Shorted turns, say, speak for wrong parameters as well where each cause is weighed alone. What counts
        is how much better both explain the record than the change does.

        Parameters
        ----------
        cause : Cause
            The cause.
        changes : frozenset of Cause
            Changes of which one is there; where there are several, each counts as the record tells it.

        Returns
        -------
        float or None
            Log of the likelihood ratio [nats]; None where the record tells nothing of the cause.
        """
        ratios = self.log_likelihood_ratios
        if cause not in ratios:
            return None
        alone = ratios[cause]
        if cause not in OF_ONE_ASYMMETRY:
            return alone
        rivals = changes & OF_ONE_ASYMMETRY & ratios.keys()
        explained = max((ratios[one] for one in rivals), default=0.0)
        return max(alone - max(explained, 0.0), min(alone, 0.0))


def _list_of(value: object, field: str) -> list[Mapping[str, Any]]:
    if not isinstance(value, list):
        raise TypeError(f"{field}: expected a list, found {type(value).__name__}")
    return value


def median_beside(records: Sequence[RecordAnswer], cause: Cause, changes: Causes) -> float | None:
    """Return the median of what records tell of a cause beside one of some changes.

    Records of one motor share its errors, so that more of them make a figure steadier, but not surer.
    """
    told = [found for one in records if (found := one.beside(cause, changes)) is not None]
    return median(told) if told else None


def latest_figure(records: Sequence[RecordAnswer], cause: Cause) -> str:
    """Return what the latest record that tells of a cause has measured of it."""
    telling = [one for one in records if cause in one.log_likelihood_ratios]
    return telling[-1].figures.get(cause, "") if telling else ""
