"""`mcc check --fail-on`: whether a motor is on watch or has a fault, for cron and other programs."""

from collections.abc import Sequence

from rich.text import Text

from core.error_words import one_line
from service.cli.output import DONE, FAILED, failing_clearly, print_document, results
from service.client.conditions import condition_of, since_day, state_text
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import level

AT_OR_BEYOND = {"watch": ("fault", "watch"), "fault": ("fault",)}
"""States, the worst first."""


def check_conditions(url: str, fail_on: str, *, as_json: bool) -> int:
    """Print the motors whose condition is at a state or beyond, the worst first.

    Returns the exit code: 1 where there are any. Prints nothing where there are none, so that cron sends no
    mail. Raises CommandError, which ends with 1 too: nobody knows how the motors are then.
    """
    states = AT_OR_BEYOND[fail_on]
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        motors = list(service.list_motors(health=True, limit=1000))
        found = sorted(_at(motors, states), key=lambda one: states.index(str(one["state"])))
    if as_json:
        print_document({"fail_on": fail_on, "motors": len(motors), "found": found})
    else:
        for condition in found:
            results().print(_line(condition), soft_wrap=True)
    return FAILED if found else DONE


def _at(motors: Sequence[Document], states: Sequence[str]) -> list[Document]:
    """Return the conditions that are in one of the states. Raises ServiceError."""
    conditions = []
    for motor in motors:
        health = motor.get("health")
        if not isinstance(health, dict):
            raise ServiceError("there is no health in the list of motors: is the service too old?")
        conditions.append(condition_of(health))
    return [condition for condition in conditions if condition["state"] in states]


def _line(condition: Document) -> Text:
    line = Text(f"{one_line(str(condition['motor']))}: ")
    line.append_text(state_text(condition))
    if condition["mu_f"] is not None:
        line.append(f", {level(condition['mu_f'], condition['mu_f_ci95'])}")
    if condition["since"] is not None:
        line.append(f", since {since_day(condition)}")
    if condition["stale"]:
        line.append(", stale: no newer record counts")
    return line
