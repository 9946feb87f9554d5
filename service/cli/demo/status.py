"""`mcc demo-status`: the conditions of a demo plant beside the truth, and whether they are right."""

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.error_words import one_line
from service.cli.output import failing_clearly, print_document, results
from service.client.conditions import state_text
from service.client.rest_client import ServiceClient, ServiceError
from service.client.rotor_conditions import rotor_text
from service.client.tables import FittedTable
from service.client.verdicts import level, verdict_text
from service.demo.open_alarms import alarm_text
from service.demo.results import truth_text
from service.demo.status import MotorStatus, ask_plant
from service.demo.truth import TruthError


def show_demo(url: str, *, as_json: bool) -> None:
    """Print each motor's condition and truth. Raises CommandError."""
    with failing_clearly(ServiceError, TruthError), ServiceClient(url) as service:
        motors = ask_plant(service)
        right = sum(motor.is_right is True for motor in motors)
        judged = sum(motor.is_right is not None for motor in motors)
    if as_json:
        print_document({"motors": [motor.as_dict() for motor in motors], "right": right, "judged": judged})
        return
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    for heading in ("motor", "truth", "condition", "level", "latest verdict", "rotor", "link", "alarm"):
        table.add_column(heading, no_wrap=heading == "motor")
    for motor in motors:
        table.add_row(*_row(motor))
    results().print(table)
    waiting = len(motors) - judged
    results().print(
        f"{right} of {judged} motors are judged right" + (f"; {waiting} not judged yet" if waiting else "")
    )


def _row(motor: MotorStatus) -> tuple[Text, ...]:
    health = motor.health
    verdict = health["verdict"]
    reason = f": {one_line(str(health['link_reason']))}" if health["link_reason"] else ""
    return (
        Text(str(health["motor"])),
        Text(truth_text(motor.truth)),
        state_text(motor.condition),
        Text(level(motor.condition["mu_f"], motor.condition["mu_f_ci95"])),
        Text("-") if verdict is None else verdict_text(str(verdict), health["phase"]),
        Text("-") if motor.rotor is None else rotor_text(motor.rotor),
        Text(f"{health['link_state']}{reason}"),
        Text(alarm_text(motor.alarms)),
    )
