"""The state of a running demo plant: each motor's condition beside the truth."""

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from core.motor_condition.parts import Part, parts_of
from core.rotor.finding import RotorState
from scl import DEMO_PLANT_SCD
from service.client.conditions import condition_of
from service.client.rest_client import Document, ServiceClient
from service.client.rotor_conditions import rotor_of
from service.demo import MONTH, MOTORS, SCENARIO
from service.demo.month import began, latest_s
from service.demo.open_alarms import open_alarms_of
from service.demo.truth import Truth, TruthError, ask_course, ask_simulator

VERDICT = (
    "verdict", "phase", "mu_f", "mu_f_ci95", "mu_f_scatter95", "detection_limit", "load_level",
    "recorded_time",
)  # fmt: skip
LINK = ("link_state", "link_reason")

ALARM = ("id", "kind", "priority", "state", "standing", "raised_time", "reason")

MOST_NAMED = 3
"""So many motors of another plant are named."""

Truths = Mapping[str, Truth]
"""By name of the relay."""


@dataclass(frozen=True, slots=True)
class MotorStatus:
    """One motor: its health as the service reports it (GET motors/{name}/health), and the truth.

    truth: at the time of the latest record.  alarms: those of the motor that are not over.
    rotor: what its records say of the cage (GET motors/{name}/rotor).
    """

    health: Document
    truth: Truth
    alarms: Sequence[Document] = ()
    rotor: Document | None = None

    @property
    def condition(self) -> Document:
        """Its condition over its records."""
        return condition_of(self.health)

    @property
    def is_right(self) -> bool | None:
        """Whether what is said of the motor's stator is true; None while nothing is said yet.

        It is whether the condition calls it faulty, and in which phase. While its reference is being learnt,
        verdict and phase of the latest record count too, because there is little else. A fault that the
        condition has not seen yet is neither right nor wrong.
        """
        truth = self.truth.verdict, self.truth.phase
        of_stator = [one.state for one in parts_of(self.condition) if one.part is Part.STATOR]
        state, phase = of_stator[0] if of_stator else self.condition["state"], self.condition["phase"]
        if state == "fault":
            return (state, phase) == truth
        reference = self.condition["reference"]
        if not (isinstance(reference, Mapping) and reference["complete"]):
            said = self.health["verdict"], self.health["phase"]
            return None if said[0] is None else said == truth
        return None if state == "unknown" or self.truth.verdict == "fault" else True

    @property
    def is_rotor_right(self) -> bool | None:
        """Whether what is said of the rotor is true; None while nothing is said, or a bar is cracked only.

        A bar that is broken and not yet called a fault is neither right nor wrong: that takes two records.
        """
        state = None if self.rotor is None else self.rotor["state"]
        if state == RotorState.FAULT:
            return self.truth.broken_bars > 0.0
        if state == RotorState.HEALTHY:
            return True if self.truth.broken_bars == 0.0 else None
        return None

    def as_dict(self) -> dict[str, object]:
        return {
            "motor": self.health["motor"],
            "site": self.health["site"],
            "condition": self.condition,
            **{name: self.health[name] for name in VERDICT + LINK},
            "truth": self.truth.as_dict(),
            "right": self.is_right,
            "rotor": self.rotor,
            "rotor_right": self.is_rotor_right,
            "alarms": [{name: alarm[name] for name in ALARM} for alarm in self.alarms],
        }


def ask_plant(service: ServiceClient) -> list[MotorStatus]:
    """Return the status of every motor of a demo plant that runs, by the scenario that it plays.

    Raises ServiceError, TruthError where the service watches another plant.
    """
    _require_demo_plant(service)
    since = began(service, MONTH)
    if since is None:
        truths = ask_simulator(DEMO_PLANT_SCD, SCENARIO)
        return ask_status(service, lambda healths: [truths] * len(healths))
    return ask_status(service, lambda healths: truths_of_month(healths, since))


def _require_demo_plant(service: ServiceClient) -> None:
    """Raise TruthError where the motors are not the demo's: nobody knows the truth of others."""
    demo = {str(motor["name"]) for motor in tomllib.loads(MOTORS.read_text(encoding="utf-8"))["motor"]}
    found = [str(motor.get("name")) for motor in service.list_motors()]
    others = [name for name in found if name not in demo]
    if found and not others:
        return
    named = ", ".join(others[:MOST_NAMED]) + (", ..." if len(others) > MOST_NAMED else "")
    raise TruthError(
        f"expected a service that watches the demo plant, found one with {named or 'no motor'}: "
        "nobody knows the truth there; mcc motors shows the conditions of any plant"
    )


def truths_of_month(healths: Sequence[Document], since: datetime) -> Sequence[Truths]:
    """Return what was true of the month's plant at the latest record of each motor. Raises TruthError."""
    moments_s = [latest_s(health, since) for health in healths]
    return ask_course(DEMO_PLANT_SCD, MONTH, [*moments_s, 0.0])[:-1]  # a course has two moments at least


def ask_status(
    service: ServiceClient, truths_at: Callable[[Sequence[Document]], Sequence[Truths]]
) -> list[MotorStatus]:
    """Return the status of every motor.

    truths_at: takes the motors' healths, and returns for each the truths at the time of its latest record.
    Raises ServiceError, TruthError where the service watches another plant.
    """
    healths = [_health(service, str(motor["name"])) for motor in service.list_motors()]
    alarms = open_alarms_of(service)
    return [
        MotorStatus(
            health,
            _truth_of(str(health["ied"]), truths),
            alarms.get(str(health["motor"]), ()),
            rotor_of(service, str(health["motor"])),
        )
        for health, truths in zip(healths, truths_at(healths), strict=True)
    ]


def _health(service: ServiceClient, motor: str) -> Document:
    return service.get_health(motor)


def _truth_of(relay: str, truths: Truths) -> Truth:
    if relay not in truths:
        raise TruthError(f"expected a service that watches the demo plant, found one with the relay {relay}")
    return truths[relay]
