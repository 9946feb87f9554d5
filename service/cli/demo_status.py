"""`mcc demo-status`: the latest verdicts of a demo plant, and whether they are right."""

from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

import scl
from service.cli.output import failing_clearly, one_line, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.verdicts import level, verdict_text
from service.demo import SCENARIO
from service.demo.results import truth_text
from service.demo.status import MotorStatus, ask_status
from service.demo.truth import TruthError, ask_simulator


def show_demo(url: str, *, as_json: bool) -> None:
    """Print each motor's verdict and truth. Raises CommandError."""
    with failing_clearly(ServiceError, TruthError), ServiceClient(url) as service:
        motors = ask_status(service, ask_simulator(scl.DEMO_PLANT_SCD, SCENARIO))
    right = sum(motor.is_right for motor in motors)
    if as_json:
        print_document({"motors": [motor.as_dict() for motor in motors], "right": right})
        return
    table = Table(box=SIMPLE_HEAD, collapse_padding=True)
    for heading in ("motor", "truth", "verdict", "level", "link"):
        table.add_column(heading)
    for motor in motors:
        table.add_row(*_row(motor))
    results().print(table)
    results().print(f"{right} of {len(motors)} verdicts are right")


def _row(motor: MotorStatus) -> tuple[Text, ...]:
    health = motor.health
    verdict = health["verdict"]
    reason = f": {one_line(str(health['link_reason']))}" if health["link_reason"] else ""
    return (
        Text(str(health["motor"])),
        Text(truth_text(motor.truth)),
        Text("-") if verdict is None else verdict_text(str(verdict), health["phase"]),
        Text(level(health["mu_f"], health["mu_f_ci95"])),
        Text(f"{health['link_state']}{reason}"),
    )
