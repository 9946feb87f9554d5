"""The phase of shorted turns in words, the same in reasons, commands and pages."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

from core.diagnosis.causes import Cause

NAMED_PHASE: Final = 0.95
"""Probability from which on a phase is named alone."""
POSSIBLE_PHASE: Final = 0.05
"""Probability from which on a phase is named beside another."""


def turns_phase_in_words(document: Mapping[str, Any]) -> str | None:
    """Return the phase of the shorted turns that a diagnosis found, in words.

    Parameters
    ----------
    document : mapping
        The diagnosis, as `Diagnosis.as_dict` returns it.

    Returns
    -------
    str or None
        As `phase_in_words`; None where shorted turns are not what was found.
    """
    if document["phase"] is not None:
        return str(document["phase"])
    found = document["hypotheses"]
    if not found or found[0]["cause"] != Cause.SHORTED_TURNS or document["verdict"] == "healthy":
        return None
    return phase_in_words(document["phase_probabilities"])


def phase_in_words(probabilities: Sequence[float] | None, *, with_shares: bool = True) -> str:
    """Return the phase of shorted turns in words.

    Parameters
    ----------
    probabilities : sequence of float or None
        Probability of phase a, b, c.
    with_shares : bool, optional
        Whether likely phases have their probabilities beside them.

    Returns
    -------
    str
        Such as "a", or "a (72 %) or c (28 %)" where none is likely enough to be named alone, "a or c" without
        probabilities; empty where nothing is known of the phase.
    """
    if probabilities is None:
        return ""
    by_phase = sorted(zip(probabilities, "abc", strict=True), key=lambda one: -one[0])
    likeliest, name = by_phase[0]
    if likeliest >= NAMED_PHASE:
        return name
    likely = [(share, one) for share, one in by_phase if share >= POSSIBLE_PHASE]
    return " or ".join(f"{one} ({100 * share:.0f} %)" if with_shares else one for share, one in likely)
