"""The state of a running demo plant: each motor's latest verdict beside the truth."""

from collections.abc import Mapping
from dataclasses import dataclass

from scl import DEMO_PLANT_SCD
from service.client.conditions import condition_of
from service.client.rest_client import Document, ServiceClient, segment
from service.demo import MONTH, SCENARIO
from service.demo.month import began, latest_s
from service.demo.truth import Truth, TruthError, ask_simulator

VERDICT = (
    "verdict", "phase", "mu_f", "mu_f_ci95", "mu_f_scatter95", "detection_limit", "load_level",
    "recorded_time",
)  # fmt: skip
LINK = ("link_state", "link_reason")


@dataclass(frozen=True, slots=True)
class MotorStatus:
    """One motor: its health as the service reports it (GET motors/{name}/health), and the truth.

    develops: it is judged by its condition, because faults develop that no single record shows at first.
    """

    health: Document
    truth: Truth
    develops: bool = False

    @property
    def condition(self) -> Document:
        """Its condition over its records."""
        return condition_of(self.health)

    @property
    def is_right(self) -> bool | None:
        """Whether what is said of the motor is true; None while nothing is said yet.

        It is verdict and faulted phase of the latest record. Of a motor that develops it is whether it is
        called faulty, and in which phase, and None while a fault has not been seen yet.
        """
        truth = self.truth.verdict, self.truth.phase
        if not self.develops:
            said = self.health["verdict"], self.health["phase"]
            return None if said[0] is None else said == truth
        state, phase = self.condition["state"], self.condition["phase"]
        if state == "fault":
            return (state, phase) == truth
        return None if state == "unknown" or self.truth.verdict == "fault" else True

    def as_dict(self) -> dict[str, object]:
        return {
            "motor": self.health["motor"],
            "site": self.health["site"],
            "condition": self.condition,
            **{name: self.health[name] for name in VERDICT + LINK},
            "truth": self.truth.as_dict(),
            "right": self.is_right,
        }


def ask_plant(service: ServiceClient) -> list[MotorStatus]:
    """Return the status of every motor of a demo plant that runs, by the scenario that it plays.

    Raises ServiceError, TruthError.
    """
    since = began(service)
    if since is None:
        return ask_status(service, ask_simulator(DEMO_PLANT_SCD, SCENARIO))
    healths = [_health(service, str(motor["name"])) for motor in service.items("/motors")]
    at_s = max((latest_s(health, since) for health in healths), default=0.0)
    return ask_status(service, ask_simulator(DEMO_PLANT_SCD, MONTH, at_s), develops=True)


def ask_status(
    service: ServiceClient, truths: Mapping[str, Truth], *, develops: bool = False
) -> list[MotorStatus]:
    """Return the status of every motor. truths: by name of the relay.

    Raises ServiceError, TruthError where the service watches another plant.
    """
    return [
        MotorStatus(
            _health(service, str(motor["name"])), _truth_of(str(motor["ied"]), truths), develops=develops
        )
        for motor in service.items("/motors")
    ]


def _health(service: ServiceClient, motor: str) -> Document:
    return service.get(f"/motors/{segment(motor)}/health")


def _truth_of(relay: str, truths: Mapping[str, Truth]) -> Truth:
    if relay not in truths:
        raise TruthError(f"expected a service that watches the demo plant, found one with the relay {relay}")
    return truths[relay]
