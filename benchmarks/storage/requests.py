"""What is asked of the API: every route that reads, with each filter, at the beginning and far down."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from string import Formatter
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from fastapi import FastAPI

from benchmarks.storage import rows
from benchmarks.storage.condition_rows import EVENT, TOLD
from benchmarks.storage.plant import BUSY, IDLE, QUIET, motor_name, relay_name
from core.time_stamps import rfc3339
from service.api.pages import encode

LIST_GOAL_S = 0.050
GOALS_S = {"/api/v1/motors/{name}/trend": 0.030, "/metrics": 0.100, "/api/v1/alarms/figures": 0.300}
"""How long a route may take, of a hundred requests the 95th; all others LIST_GOAL_S."""

UNTIMED = {
    "/api/v1/recordings/{recording_id}/waveform": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/file": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/csv": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/model": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/phasors": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/samples": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/spectrum": "reads one record from the recording store",
    "/api/v1/recordings/{recording_id}/states": "reads one record from the recording store",
    "/api/v1/motors/{name}/starts/{recording_id}": "reads one row of starts, and a few of the reference",
    "/api/v1/reports/alarms": "writes a month's alarms into a file",
    "/api/v1/reports/fleet": "writes the whole fleet into a file",
    "/api/v1/reports/motors/{name}": "writes all of a motor into a file",
    "/api/v1/audit/export": "reads the whole trail",
    "/api/v1/audit/verification": "reads the whole trail",
    "/api/v1/exports/alarms": "writes all that is chosen into a file",
    "/api/v1/exports/inspections": "writes all that is chosen into a file",
    "/api/v1/exports/measurements": "writes all that is chosen into a file",
    "/api/v1/exports/recordings": "writes all that is chosen into a file",
    "/api/v1/exports/starts": "writes all that is chosen into a file",
    "/api/v1/exports/trend": "writes all that is chosen into a file",
    "/api/v1/notifications": "reads messages, which are deleted after a time",
    "/api/v1/notifications/{notification_id}": "reads messages, which are deleted after a time",
    "/api/v1/notification-channels": "reads messages, which are deleted after a time",
    "/api/v1/motors/{name}/inspections": "reads what people told of a motor, 500 at most",
    "/api/v1/motors/{name}/inspections/{inspection_id}": "reads one row of inspections",
    "/api/v1/motors/{name}/inspections/{inspection_id}/pictures/{number}": "reads one picture",
    "/api/v1/inspections/figures": "reads what people told of motors, 500 of each at most",
    "/healthz": "asks the database nothing",
    "/api/v1/login": "asks the database nothing",
    "/api/v1/login/passkey": "asks the database nothing",
    "/api/v1/account": "reads one row of users, who are few",
    "/api/v1/account/tokens": "reads the tokens of one user, a hundred at most",
    "/api/v1/account/passkeys": "reads the passkeys of one user, twenty at most",
    "/api/v1/tokens": "reads tokens, which are few",
    "/api/v1/users": "reads users, who are few",
    "/api/v1/users/{name}": "reads one row of users, who are few",
}
"""Routes that read, and why they are not timed."""

_MOTOR = ("{busy}", "{quiet}", "{idle}", "{some}")
_RELAY = ("{busy_relay}", "{some_relay}")
_TREND = (
    *_MOTOR,
    *(f"{motor}?limit=1000" for motor in _MOTOR),
    "{busy}?limit=1000&cursor={deep}",
    "{busy}?limit=1000&from={from}&to={to}",
)

TIMED: Mapping[str, tuple[str, ...]] = {
    "/api/v1/sites": ("", "?limit=2&cursor={name}"),
    "/api/v1/sites/{name}/planned-stop": ("{site}",),
    "/api/v1/motors/{name}/planned-stop": _MOTOR,
    "/api/v1/motors": ("", "?limit=1000", "?health=true", "?health=true&cursor={name}", "?cursor={name}"),
    "/api/v1/motors/{name}": ("{some}",),
    "/api/v1/motors/{name}/health": _MOTOR,
    "/api/v1/motors/{name}/trend": (
        *_MOTOR,
        *(f"{motor}?limit=1000" for motor in _MOTOR),
        "{busy}?limit=1000&cursor={deep}",
        "{busy}?limit=1000&quantity=load_level",
        "{busy}?limit=1000&quantity=theta_f&from={from}",
        "{busy}?limit=1000&to={to}",
        "{busy}?limit=1000&from={from}&to={to}&cursor={deep}",
        "{busy}?limit=1000&quantity=condition_level",
        "{busy}?limit=1000&quantity=change&from={from}&to={to}&cursor={deep}",
    ),
    "/api/v1/motors/{name}/condition": (*_MOTOR, "{busy}?history=100"),
    "/api/v1/motors/{name}/condition/history": (*_MOTOR, "{busy}?limit=1000", "{busy}?cursor={deep}"),
    "/api/v1/motors/{name}/parameters": _MOTOR,
    "/api/v1/motors/{name}/parameters/trend": _TREND,
    "/api/v1/motors/{name}/rotor": _MOTOR,
    "/api/v1/motors/{name}/classification": _MOTOR,
    "/api/v1/motors/{name}/rotor/trend": _TREND,
    "/api/v1/motors/{name}/supply/trend": _TREND,
    "/api/v1/motors/{name}/swings/trend": _TREND,
    "/api/v1/motors/{name}/starts": (*_MOTOR, "{busy}?limit=1000", "{busy}?cursor={deep}"),
    "/api/v1/motors/{name}/relay-events": (*_MOTOR, "{busy}?limit=1000", "{busy}?cursor={deep}"),
    "/api/v1/motors/{name}/losses": _MOTOR,
    "/api/v1/motors/{name}/load-profile": (*_MOTOR, "{busy}?days=1", "{busy}?days=90"),
    "/api/v1/motors/{name}/notes": (*_MOTOR, "{busy}?limit=1000", "{busy}?cursor={deep}"),
    "/api/v1/motors/{name}/notes/{note_id}": ("{busy} {note}",),
    "/api/v1/motors/{name}/recordings": (
        *_MOTOR,
        "{busy}?limit=1000",
        "{busy}?cursor={deep}",
        "{busy}?operation=start",
    ),
    "/api/v1/motors/{name}/baseline": ("{busy}",),
    "/api/v1/motors/{name}/measurements": (
        *_MOTOR,
        "{busy}?limit=1000",
        "{busy}?step=60",
        "{busy}?step=900&from={from}",
        "{busy}?step=60&to={to}&cursor={deep_time}",
        "{some}?from={from}&to={to}",
    ),
    "/api/v1/ieds": ("", "?limit=1000", "?cursor={relay}"),
    "/api/v1/ieds/{name}": _RELAY,
    "/api/v1/ieds/{name}/link-changes": (*_RELAY, "{busy_relay}?limit=1000", "{some_relay}?cursor={deep}"),
    "/api/v1/gateways": ("",),
    "/api/v1/job-runners": ("",),
    "/api/v1/integrations": ("",),
    "/api/v1/alarms": (
        "",
        "?limit=1000",
        "?cursor={deep}",
        "?standing=true",
        "?standing=true&cursor={bad}",
        "?standing=false&cursor={deep}",
        "?ied={some_relay}",
        "?ied={some_relay}&cursor={deep}",
        "?ied={some_relay}&standing=true",
        "?ied={some_relay}&standing=false&cursor={deep}",
        "?motor={some}",
        "?motor={some}&standing=true",
        "?motor={busy}&standing=false&cursor={deep}",
        "?part_of={alarm}",
    ),
    "/api/v1/alarms/open": (
        "",
        "?limit=1000",
        "?cursor={open}",
        "?site={site}",
        "?ied={some_relay}",
        "?motor={some}",
        "?state=unacknowledged&cursor={open}",
    ),
    "/api/v1/alarms/figures": ("", "?days=366"),
    "/api/v1/alarms/{alarm_id}": ("{alarm}",),
    "/api/v1/alarms/{alarm_id}/changes": ("{alarm}", "{alarm}?limit=1000", "{alarm}?cursor={change}"),
    "/api/v1/event-reports": (
        "",
        "?limit=1000",
        "?cursor={deep}",
        *(f"?motor={motor}" for motor in _MOTOR),
        "?motor={busy}&cursor={deep}",
        "?motor={some}&cursor={deep}",
    ),
    "/api/v1/event-reports/{report_id}": ("{report}",),
    "/api/v1/recordings": (
        "",
        "?limit=1000",
        "?cursor={deep}",
        *(f"?state={state}" for state in ("announced", "fetched", "diagnosed", "rejected", "failed")),
        "?state=failed&limit=1000",
        "?state=failed&cursor={bad}",
        "?state=diagnosed&cursor={deep}",
        *(f"?motor={motor}" for motor in _MOTOR),
        "?motor={busy}&cursor={deep}",
        *(f"?motor={motor}&state=failed" for motor in _MOTOR),
        "?motor={busy}&state=rejected&cursor={deep}",
        "?motor={some}&state=announced",
        "?operation=start",
        "?operation=start&cursor={deep}",
        *(f"?motor={motor}&operation=start" for motor in _MOTOR),
    ),
    "/api/v1/recordings/{recording_id}": ("{recording}",),
    "/api/v1/recordings/{recording_id}/diagnoses": ("{recording}", "{recording}?limit=1&cursor={deep}"),
    "/api/v1/recordings/{recording_id}/diagnoses/{diagnosis_id}": ("{recording} {job}",),
    "/api/v1/deletions": (
        "",
        "?limit=1000",
        "?cursor={deep}",
        *(f"?motor={motor}" for motor in _MOTOR),
        "?motor={busy}&cursor={deep}",
    ),
    "/api/v1/deletions/{recording_id}": ("{deletion}",),
    "/api/v1/audit/entries": (
        "",
        "?limit=1000",
        "?cursor={change}",
        "?actor=person 1",
        "?action=recording-requested",
        "?subject={some_name}",
        "?from={from}&to={to}",
    ),
    "/api/v1/audit/head": ("",),
    "/api/v1/backups": ("", "?limit=1000", "?cursor={deep}"),
    "/readyz": ("",),
    "/metrics": ("",),
}
"""The requests of each route: what takes the places of its path, and the query behind it."""


@dataclass(frozen=True, slots=True)
class Ask:
    """A request whose places are filled anew each time, and how long it may take [s]."""

    route: str
    label: str
    path: str
    goal_s: float

    def at(self, position: float, amounts: rows.Amounts) -> str:
        """Return its path with what lies at a position of the years, from 0 to 1."""
        return self.path.format_map(_places(position, amounts))


def asks(app: FastAPI) -> Iterator[Ask]:
    """Yield all that is asked. Raises LookupError for a route or a filter that nobody has thought of."""
    found = {path: methods["get"] for path, methods in app.openapi()["paths"].items() if "get" in methods}
    forgotten = sorted(set(found) - set(TIMED) - set(UNTIMED))
    gone = sorted((set(TIMED) | set(UNTIMED)) - set(found))
    if forgotten or gone:
        raise LookupError(f"routes neither timed nor excused: {forgotten}; routes that are no more: {gone}")
    for route, requests in TIMED.items():
        unused = _parameters(found[route]) - {name for one in requests for name, _ in _query(one)}
        if unused:
            raise LookupError(f"{route}: no request uses {sorted(unused)}")
        for request in requests:
            yield _ask(route, request)


def _ask(route: str, request: str) -> Ask:
    values, mark, query = request.partition("?")
    path = route
    for (_, place, _, _), value in zip(
        [part for part in Formatter().parse(route) if part[1]], values.split(), strict=True
    ):
        path = path.replace(f"{{{place}}}", value)
    path = f"{path}{mark}{query}"
    return Ask(route, path.removeprefix("/api/v1"), path, GOALS_S.get(route, LIST_GOAL_S))


def _parameters(operation: Mapping[str, Any]) -> set[str]:
    """Return the query parameters of a route, without the one that gives the same rows as a file."""
    return {one["name"] for one in operation.get("parameters", ()) if one["in"] == "query"} - {"format"}


def _query(request: str) -> list[tuple[str, str]]:
    return parse_qsl(urlsplit(request).query)


def _places(position: float, amounts: rows.Amounts) -> Mapping[str, str]:
    """Return what takes the places of a path."""
    time_ns = rows.BEGIN_NS + int(position * rows.SPAN_NS)
    bad_ns = rows.BEGIN_NS + int(position * rows.SPAN_NS) // rows.BAD_MONTH
    some = IDLE + 1 + int(position * (amounts.motors - IDLE - 1))
    diagnosed = int(position * amounts.recordings * 0.9) // rows.REDIAGNOSED * rows.REDIAGNOSED
    return {
        "busy": motor_name(BUSY),
        "quiet": motor_name(QUIET),
        "idle": motor_name(IDLE),
        "some": motor_name(some),
        "name": encode((motor_name(some),)),
        "busy_relay": relay_name(BUSY),
        "some_relay": relay_name(some),
        "relay": encode((relay_name(some),)),
        "deep": encode((time_ns, "8")),
        "deep_time": encode((time_ns,)),
        "open": encode((30, bad_ns, "8")),
        "site": "SITE_1",
        "some_name": motor_name(some),
        "alarm": rows.id_of(rows.ALARM, int(position * (amounts.alarms - 1))),
        "change": encode((amounts.alarms,)),
        "bad": encode((bad_ns, "8")),
        "from": rfc3339(time_ns),
        "to": rfc3339(time_ns + rows.SPAN_NS // 4),
        "recording": rows.id_of(rows.RECORDING, diagnosed),
        "note": rows.id_of(EVENT, TOLD),
        "job": rows.id_of(rows.JOB, diagnosed),
        "deletion": rows.id_of(rows.DELETION, int(position * amounts.deletions)),
        "report": rows.id_of(rows.REQUEST, int(position * amounts.recording_requests)),
    }
