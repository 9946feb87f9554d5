"""A motor's standing asymmetry as the other motors of its bus read it from the database."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from core.condition.bus.neighbours import StandingEstimate
from core.signals.sequence import PhaseSequence


def standing_document(estimate: StandingEstimate) -> dict[str, Any]:
    """Return the document of an estimate, without the motor's name."""
    return {
        "sequence": str(estimate.sequence),
        "asymmetry": estimate.asymmetry.tolist(),
        "covariance": estimate.covariance.tolist(),
        "channels": estimate.channels.tolist(),
        "others": int(estimate.others),
        "transformers": int(estimate.transformers),
    }


def standing_estimate(motor: str, document: Mapping[str, Any]) -> StandingEstimate:
    """Return the estimate that a document tells."""
    return StandingEstimate(
        motor=motor,
        sequence=PhaseSequence(document["sequence"]),
        asymmetry=np.array(document["asymmetry"]),
        covariance=np.array(document["covariance"]),
        channels=np.array(document["channels"]),
        others=document["others"],
        transformers=document["transformers"],
    )
