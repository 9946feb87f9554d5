"""What is to be done about parameters that drift, by what may have made them."""

from collections.abc import Mapping, Sequence
from typing import Final

from core.tracking.finding import DriftCause, TrackedParameters, TrackingState

ADVICE: Final[Mapping[DriftCause, str]] = {
    DriftCause.WINDING_HOT: "Check the cooling: fan, air ways, dirt, ambient temperature, and the load.",
    DriftCause.RATIO: (
        "Compare ratios and burdens of the current and voltage transformers with their plates and with the "
        "relay's settings, above all after work at them."
    ),
    DriftCause.MAGNETISING: (
        "Compare the no-load current with the first records; if the motor was opened, check air gap and "
        "winding."
    ),
    DriftCause.LEAKAGE: (
        "Compare the motor with its plate: is it the one that was here before, and not rewound?"
    ),
    DriftCause.ROTOR: (
        "Have a start recorded and compare it with the first ones (`mcc starts`), and look for broken bars."
    ),
}
NOTHING_TO_DO: Final = "Nothing needs to be done."
NOT_TOLD_APART: Final = (
    "Compare the motor and its transformers with their plates, and with the relay's settings."
)


def drift_advice(causes: Sequence[DriftCause]) -> str:
    """Return what is to be done about drifts.

    Parameters
    ----------
    causes : sequence of DriftCause
        What may have made them; none where that is not told apart.

    Returns
    -------
    str
        A sentence for each cause.
    """
    return " ".join(ADVICE[cause] for cause in causes) or NOT_TOLD_APART


def drift_reason(found: TrackedParameters) -> str:
    """Return which parameters drift, by how much, and what may have made it.

    Parameters
    ----------
    found : TrackedParameters
        What the records of a motor tell.

    Returns
    -------
    str
        In words; empty where none drifts.
    """
    drifting = [
        f"{one.name.words} {100.0 * one.change:+.1f} %"
        for one in found.parameters
        if one.state is TrackingState.DRIFTING and one.change is not None
    ]
    causes = " or ".join(cause.words for cause in found.causes)
    return "; ".join([*drifting, *([causes] if causes else [])])
