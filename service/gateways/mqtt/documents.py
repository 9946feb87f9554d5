"""What the plain topics say, as JSON."""

import json
import math
import time
from collections.abc import Mapping
from dataclasses import fields
from enum import StrEnum
from importlib.metadata import version
from typing import Final

from core.time_stamps import rfc3339
from service.gateways.plant_state.figures import MotorFigures, RelayFigures
from service.storage.records import Alarm, AlarmChange, ConditionChange

VERSION = version("statorwatch")

NAMES_OF_TIMES: Final = {"running_ns": "running_as_of", "unbalance_ns": "unbalance_as_of"}
"""Of the figures that have times of their own; what other times are of says their name."""

INTERVALS: Final = ("mu_f_ci95", "change_ci95")
"""Two numbers each, as the state of a motor and the REST API have them."""


def offline() -> bytes:
    """Return the status that the broker tells when the gateway is gone. It has no time: nobody knows it."""
    return as_json({"state": "offline"})


def online(*, is_current: bool) -> bytes:
    """Return the status of a gateway that has told the whole state."""
    told = {"state": "online", "database": "answers" if is_current else "silent"}
    return as_json({**told, "since": rfc3339(time.time_ns()), "version": VERSION})


def figures(one: MotorFigures | RelayFigures | Alarm) -> bytes:
    """Return all that is told of a motor, a relay or an open alarm."""
    return as_json(_table(one))


def alarm_change(change: AlarmChange, alarm: Alarm) -> bytes:
    """Return what happened to an alarm, and which one it is."""
    place = {"site": alarm.site, "relay": alarm.ied, "motor": alarm.motor}
    what = {"kind": alarm.kind, "subject": alarm.subject, "reason": alarm.reason, "priority": alarm.priority}
    told = _table(change)
    told["time"] = told.pop("changed")
    return as_json({**told, **place, **what})


def condition_change(change: ConditionChange) -> bytes:
    """Return how a motor's condition changed, and what caused it."""
    told = _table(change)
    for name in INTERVALS:
        del told[f"{name}_low"], told[f"{name}_high"]
        told[name] = getattr(change, name)
    return as_json({"id": change.id, **told})


def as_json(document: Mapping[str, object]) -> bytes:
    """Return the document in UTF-8."""
    return json.dumps(document, ensure_ascii=False, allow_nan=False).encode("utf-8", "replace")


def _table(record: object) -> dict[str, object]:
    return dict(
        _field(field.name, getattr(record, field.name))
        for field in fields(record)  # type: ignore[arg-type]
    )


def _field(name: str, value: object) -> tuple[str, object]:
    """Return a field as JSON knows it: times as text, numbers that are none as null."""
    if name == "ied":
        return "relay", value
    if name.endswith("_ns"):
        told = NAMES_OF_TIMES.get(name, name.removesuffix("_ns"))
        return told, rfc3339(value) if isinstance(value, int) else None
    if isinstance(value, float) and not math.isfinite(value):
        return name, None
    if isinstance(value, StrEnum):
        return name, value.value
    if isinstance(value, tuple):
        return name, [_field("", one)[1] for one in value]
    return name, value
