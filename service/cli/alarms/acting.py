"""`mcc alarms acknowledge`, `shelve`, `unshelve`, `out-of-service`, `back-in-service`."""

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

from rich.text import Text

from core.error_words import one_line
from service.cli.alarms.choosing import whole_id
from service.cli.alarms.listing import print_alarm
from service.cli.output import (
    FAILED,
    WRONG_USE,
    CommandError,
    failing_clearly,
    print_document,
    print_warning,
    results,
)
from service.client.rest_client import Document, ServiceClient, ServiceError

if TYPE_CHECKING:
    from statorwatch_client.models import AlarmState, ShelvingRequest

AT_ONCE = 100
"""So many alarms are acknowledged in one request."""

_LASTING = re.compile(r"(?P<number>\d+(?:\.\d+)?)\s*(?P<unit>min|h|d)")
_UNITS = {"min": "minutes", "h": "hours", "d": "days"}


@dataclass(frozen=True, slots=True)
class ShelvingEnd:
    """What somebody says of the end of a shelving: a time, for how long, by how much it may grow."""

    until: str | None
    lasting: str | None
    growth: str | None

    def document(self, now: datetime) -> "ShelvingRequest":
        """Return what the API is asked. Raises CommandError."""
        if self.until is not None and self.lasting is not None:
            raise _wrong("--for", "expected one of --until and --for, found both")
        if self.until is None and self.lasting is None and self.growth is None:
            raise _wrong("--until", "expected an end of the shelving: --until, --for or --growth")
        wanted: ShelvingRequest = {}
        if self.until is not None:
            wanted["until"] = self.until
        if self.lasting is not None:
            wanted["until"] = f"{now + _lasting(self.lasting):%Y-%m-%dT%H:%M:%SZ}"
        if self.growth is not None:
            wanted["growth"] = _growth(self.growth)
        return wanted


def acknowledge_alarms(
    url: str, begins: list[str], *, motor: str | None, comment: str | None, as_json: bool
) -> None:
    """Take notice of alarms, and print what came of it. Raises CommandError."""
    if bool(begins) == (motor is not None):
        raise _wrong("ALARM", "expected ids of alarms, or --motor for all of a motor")
    acknowledged: list[Document] = []
    refused: list[Document] = []
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        ids = _of_motor(service, motor) if motor is not None else [whole_id(service, one) for one in begins]
        for first in range(0, len(ids), AT_ONCE):
            done = service.acknowledge_alarms({"alarms": ids[first : first + AT_ONCE], "comment": comment})
            acknowledged += done["acknowledged"]
            refused += done["refused"]
    if as_json:
        print_document({"acknowledged": acknowledged, "refused": refused})
    elif not ids:
        results().print(Text(f"no alarm of {one_line(str(motor))} waits to be acknowledged"))
    else:
        for alarm in acknowledged:
            print_alarm(alarm)
        for one in refused:
            print_warning(str(one["detail"]))
    if refused:
        raise CommandError(f"{len(refused)} of {len(ids)} alarms were not acknowledged", exit_code=FAILED)


def shelve_alarm(url: str, begin: str, end: ShelvingEnd, *, comment: str | None, as_json: bool) -> None:
    """Set an alarm aside. Raises CommandError."""
    wanted = end.document(datetime.now(UTC))
    if comment is not None:
        wanted["comment"] = comment
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        alarm = service.shelve_alarm(whole_id(service, begin), wanted)
    _print(alarm, as_json=as_json)


def take_out_of_service(url: str, begin: str, *, comment: str | None, as_json: bool) -> None:
    """Set an alarm aside until somebody puts it back. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        alarm = service.take_alarm_out_of_service(whole_id(service, begin), {"comment": comment})
    _print(alarm, as_json=as_json)


def unshelve_alarm(url: str, begin: str, *, comment: str | None, as_json: bool) -> None:
    """End a shelving. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        alarm = service.unshelve_alarm(whole_id(service, begin), comment=comment)
    _print(alarm, as_json=as_json)


def put_back_in_service(url: str, begin: str, *, comment: str | None, as_json: bool) -> None:
    """Put an alarm back in service. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        alarm = service.put_alarm_back_in_service(whole_id(service, begin), comment=comment)
    _print(alarm, as_json=as_json)


def _print(alarm: Document, *, as_json: bool) -> None:
    if as_json:
        print_document(alarm)
    else:
        print_alarm(alarm)


def _of_motor(service: ServiceClient, motor: str) -> list[str]:
    """Return the ids of a motor's alarms that somebody has to take notice of. Raises ServiceError."""
    waiting: tuple[AlarmState, ...] = ("unacknowledged", "returned-unacknowledged")
    return [
        str(alarm["id"])
        for state in waiting
        for alarm in service.list_open_alarms(limit=1000, motor=motor, state=state)
    ]


def _documents(found: object) -> list[Document]:
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def _lasting(text: str) -> timedelta:
    found = _LASTING.fullmatch(text.strip())
    if found is None or float(found["number"]) == 0 or len(found["number"]) > 9:
        raise _wrong("--for", f"expected a time such as 30min, 8h or 3d, found {text!r}")
    return timedelta(**{_UNITS[found["unit"]]: float(found["number"])})


def _growth(text: str) -> float:
    """Return an amount; in percent where it ends so."""
    number = text.strip().removesuffix("%")
    try:
        amount = float(number) / (100 if text.strip().endswith("%") else 1)
    except ValueError:
        amount = math.nan
    if not (math.isfinite(amount) and amount > 0):
        raise _wrong("--growth", f"expected an amount above 0 such as 0.005 or 0.5%, found {text!r}")
    return amount


def _wrong(where: str, what: str) -> CommandError:
    return CommandError(f"{where}: {what}", details={"type": "WrongUse"}, exit_code=WRONG_USE)
