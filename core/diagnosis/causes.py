"""The causes that are told apart, and how often each is there before anything is measured."""

from enum import StrEnum
from math import log
from types import MappingProxyType
from typing import Final


class Cause(StrEnum):
    """Why a motor's records are as they are."""

    HEALTHY = "healthy"
    SHORTED_TURNS = "stator-shorted-turns"
    ROTOR = "rotor-asymmetry"
    CONNECTION = "high-resistance-connection"
    SUPPLY = "supply-unbalance"
    VOLTAGE_CHANNEL = "voltage-channel"
    CURRENT_CHANNEL = "current-channel"
    PULSATION = "load-pulsation"
    ECCENTRICITY = "eccentricity"
    LOAD = "load-change"
    """A load that is another than it was: loose, coupled anew, or sticking."""
    PARAMETERS = "wrong-parameters"
    BEHIND_RELAY = "load-behind-relay"
    """A load beside the motor, or capacitors that lost elements, behind the relay's transformers."""
    ASYMMETRY = "another-asymmetry"
    """An asymmetry of the windings that no other cause explains."""


Causes = frozenset[Cause]
"""Causes that are there together; none of them means healthy."""
NOTHING: Final[Causes] = frozenset()

OF_ONE_ASYMMETRY: Final = frozenset(
    {
        Cause.SHORTED_TURNS,
        Cause.CONNECTION,
        Cause.VOLTAGE_CHANNEL,
        Cause.CURRENT_CHANNEL,
        Cause.PARAMETERS,
        Cause.BEHIND_RELAY,
        Cause.ASYMMETRY,
    }
)
"""Causes that a record's phasors are weighed for. They exclude one another."""
IN_WORDS: Final = MappingProxyType(
    {
        Cause.HEALTHY: "healthy",
        Cause.SHORTED_TURNS: "shorted turns",
        Cause.ROTOR: "uneven rotor",
        Cause.CONNECTION: "high-resistance connection",
        Cause.SUPPLY: "unbalanced supply",
        Cause.VOLTAGE_CHANNEL: "wrong voltage channel",
        Cause.CURRENT_CHANNEL: "wrong current channel",
        Cause.PULSATION: "pulsating load",
        Cause.ECCENTRICITY: "eccentric rotor",
        Cause.LOAD: "changed load",
        Cause.PARAMETERS: "wrong parameters",
        Cause.BEHIND_RELAY: "capacitor or load behind the relay",
        Cause.ASYMMETRY: "asymmetry of unknown cause",
    }
)

PRIORS: Final = MappingProxyType(
    {
        # core.condition.severity.STANDING_FAULTS: stators make about a third of the failures of motors
        # (Albrecht et al., doi:10.1109/TEC.1986.4765668), of which a few in a hundred a year.
        Cause.SHORTED_TURNS: 0.01,
        # The same survey: rotors make a tenth of the failures; bars crack long before they fail.
        Cause.ROTOR: 0.01,
        # No survey is known; as frequent as the faults that it is confused with.
        Cause.CONNECTION: 0.01,
        # ANSI C84.1, annex: a third of the supplies is unbalanced by more than 1 %, 2 % by more than 3 %.
        Cause.SUPPLY: 0.05,
        # Fuses, burdens and wiring of six channels; no survey is known.
        Cause.VOLTAGE_CHANNEL: 0.01,
        Cause.CURRENT_CHANNEL: 0.01,
        # Piston compressors, belts and screens among a plant's loads.
        Cause.PULSATION: 0.05,
        # Beyond what makers allow; bearings wear slowly.
        Cause.ECCENTRICITY: 0.01,
        Cause.LOAD: 0.05,
        # Typed in by hand, or of a motor that was rewound or exchanged.
        Cause.PARAMETERS: 0.03,
        # Of a bank that is there; core.diagnosis.loads_behind has how much rarer other loads are.
        Cause.BEHIND_RELAY: 0.01,
        # Rare beside shorted turns; which of the two a single record shows is its choice.
        Cause.ASYMMETRY: 0.0003,
    }
)
"""Probability of each cause before the evidence, whatever the others are. Where no survey is known they are
round figures that make no cause certain; evidence of 5 nats outweighs any of them."""


def log_prior_odds(cause: Cause) -> float:
    """Return the log of the odds of a cause before the evidence."""
    return 0.0 if cause is Cause.HEALTHY else log(PRIORS[cause] / (1.0 - PRIORS[cause]))


def words(causes: Causes) -> str:
    """Return causes as people write them."""
    if causes <= {Cause.HEALTHY}:
        return IN_WORDS[Cause.HEALTHY]
    return " with ".join(IN_WORDS[one] for one in PRIORS if one in causes)
