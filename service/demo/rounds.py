"""A round of the demo: each motor's relay is triggered, each diagnosis is waited for."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

from service.demo.results import DemoDiagnosis, DemoMotor
from service.rest_client import Document, ServiceClient, ServiceError, segment

LIMIT_S = 40.0
POLL_PERIOD_S = 0.1

UNDER_WAY = 2
"""Motors triggered at a time: a plant's motors do not trip all at once, and a waiting queue is no news."""

STATES = ("triggered", "recorded", "fetched", "diagnosed")
"""What an event report goes through after it was requested."""


@dataclass
class _UnderWay:
    """A motor whose relay was triggered."""

    motor: DemoMotor
    report_id: str
    deadline_s: float
    steps: int = 0


def play_round(service: ServiceClient, motors: Sequence[DemoMotor], advance: Callable[[int], None]) -> None:
    """Trigger all motors; give each one more diagnosis, or the reason why there is none.

    `advance` is told how many states the event reports went through since it was told last, in all
    len(motors) * len(STATES). Raises ServiceError.
    """
    to_trigger = list(reversed(motors))
    under_way: list[_UnderWay] = []
    while to_trigger or under_way:
        while to_trigger and len(under_way) < UNDER_WAY:
            motor = to_trigger.pop()
            report = service.request_event_report(motor.name)
            under_way.append(_UnderWay(motor, str(report["id"]), time.monotonic() + LIMIT_S))
        time.sleep(POLL_PERIOD_S)
        for one in list(under_way):
            report = service.event_report(one.report_id)
            ended = _ended(service, report, late=time.monotonic() > one.deadline_s)
            steps = len(STATES) if ended else _steps(report)
            advance(steps - one.steps)
            one.steps = steps
            if ended:
                one.motor.diagnoses.append(ended)
                under_way.remove(one)


def _ended(service: ServiceClient, report: Document, *, late: bool) -> DemoDiagnosis | None:
    """What an event report has come to; None while it is under way."""
    state = report["state"]
    if state == "diagnosed":
        recording = service.get(f"/recordings/{segment(str(report['recording_id']))}")
        diagnosis = recording["diagnosis"]
        if not isinstance(diagnosis, dict):
            raise ServiceError(f"recording {report['recording_id']} is diagnosed and has no diagnosis")
        return DemoDiagnosis(diagnosis, _seconds_between(report["requested_time"], report["diagnosed_time"]))
    if state == "failed":
        return DemoDiagnosis(None, None, str(report["reason"]))
    if late:
        return DemoDiagnosis(None, None, f"still {state} after {LIMIT_S:g} s")
    return None


def _steps(report: Document) -> int:
    state = str(report["state"])
    return STATES.index(state) + 1 if state in STATES else 0


def _seconds_between(start: object, end: object) -> float:
    """Between two RFC 3339 times [s]."""
    return (datetime.fromisoformat(str(end)) - datetime.fromisoformat(str(start))).total_seconds()
