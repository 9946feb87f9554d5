"""The one answer: which causes are likely, from independent evidence and what is known before."""

from dataclasses import dataclass
from math import exp, log
from typing import Final

from core.classification.evidence import Evidence, log_sum, together
from core.classification.telling import what_tells
from core.diagnosis.causes import NOTHING, PRIORS, Cause, Causes, words

TOLD: Final = 0.9
"""Probability from which on an explanation is the answer."""
FEW: Final = 0.05
"""Explanations with less probability than this are no alternatives."""
BESIDE: Final = 0.1
"""Probability from which on a cause is told that may be there beside the answer."""
MOST_ALTERNATIVES: Final = 3
"""Explanations that an answer names at most, the likeliest among them."""
NOT_ASSESSED: Final = "not assessed"
NOTHING_SEEN: Final = "nothing is seen, and not all is known"
MOST_SHOWN: Final = 6


@dataclass(frozen=True, slots=True)
class Likelihood:
    """How likely one cause is, alone or with another.

    Parameters
    ----------
    cause : Cause
        The cause; HEALTHY means that there is none.
    probability : float
        Its probability after the evidence. Those of all causes need not add up to one.
    log_likelihood_ratio : float or None
        Log of the likelihood of all figures with this cause alone to that of a healthy motor [nats]; None
        where nothing is known of it.
    figure : str
        What was measured of it, or why nothing is known, in words.
    """

    cause: Cause
    probability: float
    log_likelihood_ratio: float | None
    figure: str

    def as_dict(self) -> dict[str, object]:
        """Return the figures as JSON takes them."""
        return {
            "cause": str(self.cause),
            "probability": self.probability,
            "log_likelihood_ratio": self.log_likelihood_ratio,
            "figure": self.figure,
        }


@dataclass(frozen=True, slots=True)
class Explanation:
    """Causes that together explain all that is measured.

    Parameters
    ----------
    causes : frozenset of Cause
        The causes; none of them for a healthy motor.
    probability : float
        Probability after the evidence.
    """

    causes: Causes
    probability: float

    @property
    def names(self) -> list[str]:
        """Names of the causes, "healthy" for none."""
        return [str(one) for one in PRIORS if one in self.causes] or [str(Cause.HEALTHY)]


@dataclass(frozen=True, slots=True)
class NotToldApart:
    """Two explanations that the evidence leaves open.

    Parameters
    ----------
    one, other : Explanation
        The explanations, the likelier first.
    tests : tuple of str
        Records and tests that would tell, the easiest first.
    """

    one: Explanation
    other: Explanation
    tests: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the alternatives as JSON takes them."""
        return {"explanations": [self.one.names, self.other.names], "tests": list(self.tests)}


@dataclass(frozen=True, slots=True)
class Classification:
    """One answer from all that is measured.

    Parameters
    ----------
    answer : Explanation
        The likeliest explanation.
    is_told : bool
        Whether it is likely enough to be the answer alone.
    likelihoods : tuple of Likelihood
        Each cause, the likeliest first.
    explanations : tuple of Explanation
        The likeliest explanations.
    not_told_apart : tuple of NotToldApart
        What is left open, and what would tell; empty where the answer is told.
    reasons : tuple of str
        Why, in words.
    """

    answer: Explanation
    is_told: bool
    likelihoods: tuple[Likelihood, ...]
    explanations: tuple[Explanation, ...]
    not_told_apart: tuple[NotToldApart, ...]
    reasons: tuple[str, ...]

    @property
    def is_assessed(self) -> bool:
        """Whether there is evidence of anything; without it the answer is only what was likely before."""
        return any(
            one.log_likelihood_ratio is not None and one.cause is not Cause.HEALTHY
            for one in self.likelihoods
        )

    @property
    def names_causes(self) -> bool:
        """Whether one cause is told, or some are left open; else nothing is seen, and not all is known."""
        return self.is_assessed and (self.is_told or bool(self.not_told_apart))

    @property
    def words(self) -> str:
        """The answer as people read it."""
        if not self.names_causes:
            return NOTHING_SEEN if self.is_assessed else NOT_ASSESSED
        if self.is_told:
            return words(self.answer.causes)
        open_ones = [self.answer, *(pair.other for pair in self.not_told_apart)]
        return "not told apart: " + " or ".join(words(one.causes) for one in open_ones)

    def as_dict(self) -> dict[str, object]:
        """Return the part `classification` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The answer; its keys are a contract. Without evidence, or where nothing is seen and nothing is
            known of the winding, it names no cause, with probability 0.
        """
        assessed, answered = self.is_assessed, self.names_causes
        likelihoods = [one for one in self.likelihoods if assessed or one.cause is not Cause.HEALTHY]
        explanations = self.explanations if assessed else ()
        return {
            "answer": self.answer.names if answered else [],
            "is_told": self.is_told,
            "probability": self.answer.probability if answered else 0.0,
            "words": self.words,
            "likelihoods": [one.as_dict() for one in likelihoods],
            "explanations": [{"causes": one.names, "probability": one.probability} for one in explanations],
            "not_told_apart": [one.as_dict() for one in self.not_told_apart],
            "reasons": list(self.reasons),
        }


def classify(evidence: Evidence) -> Classification:
    """Weigh all explanations of up to two causes by the evidence.

    Causes are independent before the evidence (`causes.PRIORS`), and the blocks of evidence are independent
    of each other given the causes. A cause of which nothing is known keeps its prior.
    """
    known = frozenset().union(*(block.causes for block in evidence.blocks))
    weighed = together(known, evidence.exclusive)
    logs = [_log_prior(causes) + sum(block.of(causes) for block in evidence.blocks) for causes in weighed]
    total = log_sum(logs)
    found = sorted(
        (Explanation(causes, exp(one - total)) for causes, one in zip(weighed, logs, strict=True)),
        key=lambda one: -one.probability,
    )
    answer = _shared(found)
    is_certain = answer.probability >= TOLD
    # A motor whose winding nothing is known of is not called healthy.
    is_told = is_certain and (bool(answer.causes) or Cause.SHORTED_TURNS in known)
    alternatives = () if is_certain else _alternatives(found)
    apart = tuple(
        NotToldApart(answer, other, what_tells(answer.causes, other.causes)) for other in alternatives
    )
    likelihoods = _likelihoods(evidence, found, known)
    return Classification(
        answer=answer,
        is_told=is_told,
        likelihoods=likelihoods,
        explanations=tuple(found[:MOST_SHOWN]),
        not_told_apart=apart,
        reasons=_reasons(evidence, answer, likelihoods),
    )


def _shared(found: list[Explanation]) -> Explanation:
    """Return what the likely explanations have in common, where that is surely there; else the likeliest.

    Whether the supply of a motor with shorted turns is unbalanced, say, may stay open: the turns do not.
    """
    reached, shared = 0.0, found[0].causes
    for one in found:
        if reached >= TOLD:
            break
        reached += one.probability
        shared &= one.causes
    if not shared:
        return found[0]
    return Explanation(shared, sum(one.probability for one in found if shared <= one.causes))


def _log_prior(causes: Causes) -> float:
    return sum(log(PRIORS[one] / (1.0 - PRIORS[one])) for one in causes)


def _alternatives(found: list[Explanation]) -> tuple[Explanation, ...]:
    """Return the explanations beside the likeliest that together reach what an answer needs."""
    reached = found[0].probability
    chosen: list[Explanation] = []
    for one in found[1:MOST_ALTERNATIVES]:
        if reached >= TOLD or (chosen and one.probability < FEW):
            break
        chosen.append(one)
        reached += one.probability
    return tuple(chosen)


def _likelihoods(evidence: Evidence, found: list[Explanation], known: Causes) -> tuple[Likelihood, ...]:
    figures = {cause: figure for block in evidence.blocks for cause, figure in block.figures.items()}
    told = [
        Likelihood(
            cause,
            sum(one.probability for one in found if cause in one.causes),
            sum(block.of(frozenset({cause})) for block in evidence.blocks),
            figures.get(cause, ""),
        )
        for cause in known
    ]
    healthy = next(one.probability for one in found if one.causes == NOTHING)
    told.append(Likelihood(Cause.HEALTHY, healthy, 0.0, "no cause at all"))
    told.sort(key=lambda one: (-one.probability, one.cause))
    untold = [
        Likelihood(cause, PRIORS[cause], None, reason)
        for cause, reason in evidence.untold.items()
        if cause not in known
    ]
    return (*told, *untold)


def _reasons(evidence: Evidence, answer: Explanation, likelihoods: tuple[Likelihood, ...]) -> tuple[str, ...]:
    figures = {one.cause: one.figure for one in likelihoods}
    reasons = [f"{words(frozenset({one}))}: {figures[one]}" for one in PRIORS if one in answer.causes]
    reasons += [
        f"the verdict differs: {verdict.words}. It is what raises alarms; this answer weighs all causes"
        for verdict in evidence.verdicts
        if verdict.is_there != (verdict.cause in answer.causes)
    ]
    reasons += [
        f"{words(frozenset({one.cause}))} may be there too ({one.probability:.0%}): {one.figure}"
        for one in likelihoods
        if answer.causes
        and one.cause not in answer.causes
        and one.log_likelihood_ratio is not None
        and one.probability >= BESIDE
    ]
    untold = [words(frozenset({one.cause})) for one in likelihoods if one.log_likelihood_ratio is None]
    if untold:
        reasons.append(f"nothing is known of: {', '.join(untold)}")
    return tuple(reasons)
