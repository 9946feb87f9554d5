"""What the answer of a motor needs of the answers of its records."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from core.classification.causes import Cause, Causes
from core.classification.evidence import log_sum


@dataclass(frozen=True, slots=True)
class RecordAnswer:
    """What the answer of one record keeps for that of its motor.

    Parameters
    ----------
    log_likelihood_ratios : mapping of Cause to float
        Of each cause alone; those that the record tells [nats].
    figures : mapping of Cause to str
        What was measured of each, in words.
    pairs : mapping of frozenset of Cause to float or None, optional
        The same of two causes that show in the same figures; None of a record that an earlier version
        answered, which kept none.
    """

    log_likelihood_ratios: Mapping[Cause, float]
    figures: Mapping[Cause, str]
    pairs: Mapping[Causes, float] | None = None

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
        pairs = document.get("pairs")
        return cls(
            {Cause(one["cause"]): float(one["log_likelihood_ratio"]) for one in told},
            {Cause(one["cause"]): str(one["figure"]) for one in told},
            None
            if pairs is None
            else {
                frozenset(map(Cause, one["causes"])): float(one["log_likelihood_ratio"])
                for one in _list_of(pairs, "pairs")
            },
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
        apart = self.log_likelihood_ratios[one] + self.log_likelihood_ratios[other]
        return apart if self.pairs is None else self.pairs.get(frozenset({one, other}), apart)

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
        if self.pairs is None:
            explained = max((ratios[one] for one in changes & ratios.keys()), default=0.0)
            return max(alone - max(explained, 0.0), min(alone, 0.0))
        # A change that does not show in the figures of the cause explains nothing of them.
        pairs = [frozenset({one, cause}) for one in changes]
        both = [self.pairs.get(pair, alone) for pair in pairs]
        without = [sum(ratios[one] for one in pair - {cause} if pair in self.pairs) for pair in pairs]
        return log_sum(both) - log_sum(without) if pairs else alone


def _list_of(value: object, field: str) -> list[Mapping[str, Any]]:
    if not isinstance(value, list):
        raise TypeError(f"{field}: expected a list, found {type(value).__name__}")
    return value


def median_beside(records: Sequence[RecordAnswer], cause: Cause, changes: Causes) -> float | None:
    """Return the median of what records tell of a cause beside one of some changes.

    Records of one motor share its errors, so that more of them make a figure steadier, but not surer.

    Parameters
    ----------
    records : sequence of RecordAnswer
        Answers of the latest records.
    cause : Cause
        The cause.
    changes : frozenset of Cause
        Changes of which one is there, if any.

    Returns
    -------
    float or None
        The evidence [nats]; None where no record tells.
    """
    told = [found for one in records if (found := one.beside(cause, changes)) is not None]
    return median(told) if told else None


def latest_figure(records: Sequence[RecordAnswer], cause: Cause) -> str:
    """Return what the latest record that tells of a cause has measured of it.

    Parameters
    ----------
    records : sequence of RecordAnswer
        Answers of the latest records, oldest first.
    cause : Cause
        The cause.

    Returns
    -------
    str
        The figure in words; empty where none tells.
    """
    telling = [one for one in records if cause in one.log_likelihood_ratios]
    return telling[-1].figures.get(cause, "") if telling else ""
