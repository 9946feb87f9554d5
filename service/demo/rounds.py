"""A round of the demo: triggers the relay of each motor and waits for each diagnosis."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

from service.client.rest_client import Document, ServiceClient, ServiceError
from service.demo.results import DemoDiagnosis, DemoMotor

LIMIT_S = 40.0
POLL_PERIOD_S = 0.1

STATES = ("triggered", "recorded", "fetched", "diagnosed")
"""The states of a recording request after the first, in their order."""


@dataclass
class _UnderWay:
    """A motor whose relay was triggered."""

    motor: DemoMotor
    request_id: str
    deadline_s: float
    steps: int = 0


def play_round(
    service: ServiceClient,
    motors: Sequence[DemoMotor],
    advance: Callable[[int], None],
    pause: Callable[[float], None],
) -> None:
    """Trigger all motors at once; add to each its new diagnosis, or the reason why there is none.

    `advance` is told how many states the recording requests went through since it was told last, in all
    len(motors) * len(STATES). `pause` waits some seconds. Raises ServiceError.
    """
    under_way = [
        _UnderWay(motor, str(service.request_recording(motor.name)["id"]), time.monotonic() + LIMIT_S)
        for motor in motors
    ]
    while under_way:
        pause(POLL_PERIOD_S)
        for one in list(under_way):
            request = service.get_event_report(one.request_id)
            ended = _ended(service, request, late=time.monotonic() > one.deadline_s)
            steps = len(STATES) if ended else _steps(request)
            advance(steps - one.steps)
            one.steps = steps
            if ended:
                one.motor.diagnoses.append(ended)
                under_way.remove(one)


def _ended(service: ServiceClient, request: Document, *, late: bool) -> DemoDiagnosis | None:
    """The result of a recording request; None while it is under way."""
    state = request["state"]
    if state == "diagnosed":
        recording = service.get_recording(str(request["recording_id"]))
        diagnosis = recording["diagnosis"]
        if not isinstance(diagnosis, dict):
            raise ServiceError(f"recording {request['recording_id']} is diagnosed and has no diagnosis")
        return DemoDiagnosis(
            diagnosis, _seconds_between(request["requested_time"], request["diagnosed_time"])
        )
    if state == "failed":
        return DemoDiagnosis(None, None, str(request["reason"]))
    if late:
        return DemoDiagnosis(None, None, f"still {state} after {LIMIT_S:g} s")
    return None


def _steps(request: Document) -> int:
    state = str(request["state"])
    return STATES.index(state) + 1 if state in STATES else 0


def _seconds_between(start: object, end: object) -> float:
    """Between two RFC 3339 times [s]."""
    return (datetime.fromisoformat(str(end)) - datetime.fromisoformat(str(start))).total_seconds()
