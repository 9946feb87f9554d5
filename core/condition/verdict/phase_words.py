"""What a condition is of, and in which phase, in words: the same on pages, in alarms and in messages."""

from collections.abc import Callable, Collection, Sequence

from core.condition.assessment import Phases
from core.condition.kinds import Kind
from core.diagnosis.phase_words import phase_in_words


def turns_phases(kinds: Collection[str], probabilities: Sequence[float] | None) -> Phases | None:
    """Return the probability of each phase where shorted turns are what was found, or may be.

    Parameters
    ----------
    kinds : collection of str
        Kind of the condition, and what an unclear kind may be.
    probabilities : sequence of float or None
        Probability of phase a, b, c, should it be shorted turns.

    Returns
    -------
    tuple of float or None
        The probabilities; None of another kind, and where nothing is known of the phase.
    """
    if probabilities is None or Kind.SHORTED_TURNS not in kinds:
        return None
    a, b, c = probabilities
    return a, b, c


def kinds_in_words(
    kinds: Collection[str],
    phase: str | None,
    probabilities: Sequence[float] | None,
    words: Callable[[str], str],
    *,
    with_shares: bool = True,
) -> str:
    """Return what was found, or may be; shorted turns in no sure phase have the likely ones.

    Parameters
    ----------
    kinds : collection of str
        The kind, or what an unclear one may be, likeliest first.
    phase : str or None
        Phase of what was found; None where it is not sure. It is not in the words.
    probabilities : sequence of float or None
        Probability of phase a, b, c, should it be shorted turns.
    words : callable
        Words of a kind.
    with_shares : bool, optional
        Whether likely phases have their probabilities beside them.

    Returns
    -------
    str
        Such as "shorted turns in phase a (72 %) or c (28 %)".
    """
    likely = "" if phase is not None else phase_in_words(probabilities, with_shares=with_shares)
    where = f" in phase {likely}" if likely else ""
    return " or ".join(f"{words(one)}{where if one == Kind.SHORTED_TURNS else ''}" for one in kinds)
