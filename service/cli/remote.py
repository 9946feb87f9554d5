"""`mcc trigger`, `motors`, `health`, `release`, `delete`: requests to the REST API of a running service."""

import time
from collections.abc import Mapping

from rich.box import SIMPLE_HEAD
from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from service.cli.output import CommandError, failing_clearly, one_line, print_document, progress, results
from service.client.rest_client import Document, ServiceClient, ServiceError, segment
from service.client.verdicts import (
    detection,
    interval,
    level,
    load,
    percent,
    to_the_second,
    verdict_text,
)

ENDED = ("diagnosed", "failed")
POLL_PERIOD_S = 0.25
LINK_COLOURS = {"up": "green", "down": "red", "quarantined": "red"}
NO_RECORDING = "no recording yet"


def trigger_motor(url: str, motor: str, *, key: str | None, wait_s: float, as_json: bool) -> None:
    """Request a recording of a motor and, for at most `wait_s`, follow it to its verdict.

    The same `key` again requests nothing new; the first request with it is followed.

    Raises CommandError.
    """
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        request = service.request_recording(motor, idempotency_key=key)
        _warn_of_a_link_that_is_down(service, motor)
        deadline_s = time.monotonic() + wait_s
        state = request["state"]
        while state not in ENDED and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            request = service.recording_request(str(request["id"]))
            if request["state"] != state:
                state = request["state"]
                progress().print(f"{motor}: {state}")
        if state == "diagnosed":
            recording = service.get(f"/recordings/{segment(str(request['recording_id']))}")
            request = {**request, "diagnosis": recording["diagnosis"]}
    if state == "failed":
        raise CommandError(f"{motor}: {request['reason']}", details={"event_report": dict(request)})
    if wait_s and state != "diagnosed":
        raise CommandError(
            f"{motor}: still {state} after {wait_s:g} s", details={"event_report": dict(request)}
        )
    if as_json:
        print_document(request)
        return
    diagnosis = request.get("diagnosis")
    if isinstance(diagnosis, Mapping):
        results().print(_verdict_line(motor, diagnosis), soft_wrap=True)
    else:
        results().print(Text(f"{motor}: recording request {request['id']} {state}"), soft_wrap=True)


def list_motors(url: str, *, as_json: bool) -> None:
    """Print one line for each motor of the plant: its place and its condition. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        motors = list(service.items("/motors", health="true", limit="1000"))
        overviews = [_overview(_listed_health(motor)) for motor in motors]
    if as_json:
        print_document({"motors": motors})
        return
    table = Table(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("motor", no_wrap=True)
    for heading in ("site", "relay", "link", "verdict"):
        table.add_column(heading)
    for heading in ("level %", "95 % interval", "seen from %", "phase", "load"):
        table.add_column(heading, justify="right")
    table.add_column("last recording")
    for overview in overviews:
        table.add_row(*overview)
    results().print(table)


def show_health(url: str, motor: str, *, as_json: bool) -> None:
    """Print a motor's condition. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        health = _health(service, motor)
    if as_json:
        print_document(health)
        return
    table = Table(title=Text(motor), title_justify="left", show_header=False)
    for name, value in _condition(health):
        table.add_row(name, value)
    results().print(table)


def release_relay(url: str, relay: str, *, as_json: bool) -> None:
    """End the quarantine of a relay. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        before = service.get(f"/ieds/{segment(relay)}")
        service.release(relay)
        found = service.get(f"/ieds/{segment(relay)}")
    if as_json:
        print_document(found)
        return
    told = "was not set aside" if before["quarantine"] is None else "released, visited again within seconds"
    results().print(Text(f"{relay}: {told}"), soft_wrap=True)


def delete_recording(url: str, recording_id: str, reason: str, *, as_json: bool) -> None:
    """Delete a recording for good. Raises CommandError."""
    if not reason.strip():
        raise CommandError("--reason: expected a few words, found none")
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        deletion = service.delete_recording(recording_id, reason)
    if as_json:
        print_document(deletion)
        return
    what = one_line(f"{deletion['motor']}: recording {deletion['name']} ({recording_id}) is deleted")
    results().print(Text(what), soft_wrap=True)


def _health(service: ServiceClient, motor: str) -> Document:
    return service.get(f"/motors/{segment(motor)}/health")


def _listed_health(motor: Document) -> Document:
    health = motor.get("health")
    if not isinstance(health, Mapping):
        raise ServiceError("the list of motors has no health in it: is the service older than this command?")
    return health


def _warn_of_a_link_that_is_down(service: ServiceClient, motor: str) -> None:
    """Print a warning where the relay does not answer: the request is stored, but may take long."""
    health = _health(service, motor)
    if health["link_state"] == "down":
        words = one_line(f"{motor}: the link to {health['ied']} is down: {health['link_reason']}")
        progress().print(Text(words, style="yellow"), soft_wrap=True)


def _verdict_line(motor: str, diagnosis: Document) -> Text:
    line = Text(f"{motor}: ")
    line.append_text(verdict_text(str(diagnosis["verdict"]), _phase(diagnosis)))
    if diagnosis["mu_f"] is not None:
        line.append(f", {level(diagnosis['mu_f'], diagnosis['mu_f_ci95'])}, load {_load(diagnosis)}")
        line.append(f", seen from {percent(diagnosis['detection_limit'])} %")
    else:
        line.append(one_line(f": {'; '.join(_reasons(diagnosis))}"))
    return line


def _overview(health: Document) -> tuple[RenderableType, ...]:
    last = _last_recording(health)
    return (
        Text(str(health["motor"])),
        Text(str(health["site"])),
        Text(str(health["ied"])),
        _link_with_reason(health),
        Text("-") if health["verdict"] is None else verdict_text(str(health["verdict"])),
        percent(health["mu_f"]),
        interval(health["mu_f_ci95"]),
        percent(health["detection_limit"]),
        str(health["phase"] or "-"),
        _load(health),
        Text(NO_RECORDING if last is None else last),
    )


def _condition(health: Document) -> list[tuple[str, RenderableType]]:
    """Return the lines of one motor's condition."""
    last = _last_recording(health)
    rows: list[tuple[str, RenderableType]] = []
    if health["verdict"] is not None:
        rows.append(("verdict", verdict_text(str(health["verdict"]))))
        if health["mu_f"] is not None:
            rows.append(("equivalent fault level", level(health["mu_f"], health["mu_f_ci95"])))
            rows.append(("detection limit", detection(health["detection_limit"])))
        if health["phase"] is not None:
            rows.append(("phase", str(health["phase"])))
        if health["load_level"] is not None:
            rows.append(("load level", load(health["load_level"], health["load_level_ci95"])))
        rows.extend(("reason", Text(reason)) for reason in _reasons(health))
        diagnosed = to_the_second(health["recorded_time"])
        if diagnosed != last:
            rows.append(("diagnosed recording", diagnosed))
    rows.append(("last recording", Text(NO_RECORDING if last is None else last)))
    rows.append(("site, relay", Text(f"{health['site']}, {health['ied']}")))
    rows.append(("link", _link_with_reason(health)))
    return rows


def _last_recording(health: Document) -> str | None:
    """Return when the last recording was made, and its state where it is not diagnosed."""
    last = health["last_recording"]
    if not isinstance(last, Mapping):
        return None
    when = to_the_second(last["recorded_time"] or last["announced_time"])
    if last["state"] == "diagnosed":
        return when
    reason = f": {one_line(str(last['reason']))}" if last["reason"] else ""
    return f"{when}, {last['state']}{reason}"


def _link(health: Document) -> Text:
    state = str(health["link_state"])
    return Text(state, style=LINK_COLOURS.get(state, ""))


def _link_with_reason(health: Document) -> Text:
    link = _link(health)
    if health["link_reason"] is not None:
        link.append(f": {one_line(str(health['link_reason']))}")
    return link


def _phase(diagnosis: Document) -> str:
    return "" if diagnosis["phase"] is None else f"in phase {diagnosis['phase']}"


def _load(found: Document) -> str:
    return load(found["load_level"])


def _reasons(found: Document) -> list[str]:
    reasons = found["reasons"]
    return list(dict.fromkeys(map(str, reasons))) if isinstance(reasons, list) else []
