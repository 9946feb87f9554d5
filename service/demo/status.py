"""The state of a running demo plant: each motor's latest verdict beside the truth."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.client.rest_client import Document, ServiceClient, segment
from service.demo.truth import Truth, TruthError

CONDITION = (
    "verdict", "phase", "mu_f", "mu_f_ci95", "mu_f_scatter95", "detection_limit", "load_level",
    "recorded_time",
)  # fmt: skip
LINK = ("link_state", "link_reason")


@dataclass(frozen=True, slots=True)
class MotorStatus:
    """One motor: its health as the service reports it (GET motors/{name}/health), and the truth."""

    health: Document
    truth: Truth

    @property
    def is_right(self) -> bool | None:
        """Whether verdict and faulted phase are those of the truth; None before the first verdict."""
        if self.health["verdict"] is None:
            return None
        return (self.health["verdict"], self.health["phase"]) == (self.truth.verdict, self.truth.phase)

    def as_dict(self) -> dict[str, object]:
        return {
            "motor": self.health["motor"],
            "site": self.health["site"],
            **{name: self.health[name] for name in CONDITION + LINK},
            "truth": self.truth.model_dump(),
            "right": self.is_right,
        }


def ask_status(service: ServiceClient, truths: Mapping[str, Truth]) -> list[MotorStatus]:
    """Return the status of every motor. truths: by name of the relay.

    Raises ServiceError, TruthError where the service watches another plant.
    """
    return [
        MotorStatus(
            service.get(f"/motors/{segment(str(motor['name']))}/health"), _truth_of(str(motor["ied"]), truths)
        )
        for motor in service.items("/motors")
    ]


def _truth_of(relay: str, truths: Mapping[str, Truth]) -> Truth:
    if relay not in truths:
        raise TruthError(f"expected a service that watches the demo plant, found one with the relay {relay}")
    return truths[relay]
