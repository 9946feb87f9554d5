"""`mcc trigger`, `release`, `delete`: requests to the REST API of a running service."""

import time
from collections.abc import Mapping

from rich.text import Text

from core.diagnosis.phase_words import turns_phase_in_words
from core.error_words import one_line
from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import level, load, percent, reasons_of, verdict_text

ENDED = ("diagnosed", "failed")
JOINED_ENDED = ("diagnosed", "rejected", "failed")
POLL_PERIOD_S = 0.25

SO_FAR = {
    "requested": "its relay is not asked yet",
    "triggered": "its relay was asked and has not said yet that it recorded",
    "recorded": "its relay has recorded, and the record is being fetched",
    "fetched": "the record was fetched and waits for its diagnosis",
    "diagnosed": "the recording is diagnosed",
    "skipped": "the motor stood, and no relay was asked",
}
"""How far a recording request has come, in words."""


def what_next(command: str, motor: str) -> str:
    """Return where the verdict will be seen that a command did not wait for."""
    return one_line(
        f"mcc recordings list {motor} shows what comes of it; {command} --wait 60 waits for the verdict"
    )


def trigger_motor(
    url: str, motor: str, *, key: str | None, wait_s: float, seconds: float | None, as_json: bool
) -> None:
    """Request a recording of a motor and, for at most `wait_s`, follow it to its verdict.

    The same `key` again requests nothing new; the first request with it is followed. With `seconds` a series
    of recordings is requested, and followed until it is joined and that is diagnosed.

    Raises CommandError.
    """
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        request: Document = service.request_recording(motor, idempotency_key=key, seconds=seconds)
        _warn_of_a_link_that_is_down(service, motor)
        deadline_s = time.monotonic() + wait_s
        state = request["state"]
        while state not in ENDED and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            request = service.get_event_report(str(request["id"]))
            if request["state"] != state:
                state = request["state"]
                progress().print(f"{motor}: {state}")
        not_ready = service.what_is_not_ready() if wait_s and state not in ENDED else None
        if state == "diagnosed" and seconds is not None:
            request = _joined(service, request, deadline_s)
        if state == "diagnosed":
            made = request["joined_recording_id"] or request["recording_id"]
            recording = service.get_recording(str(made))
            request = {**request, "diagnosis": recording["diagnosis"]}
    if state == "failed":
        raise CommandError(f"{motor}: {request['reason']}", details={"event_report": dict(request)})
    if wait_s and state != "diagnosed":
        because = "" if not_ready is None else one_line(f"; the service is not ready: {not_ready}")
        raise CommandError(
            f"{motor}: no verdict within {wait_s:g} s: {SO_FAR.get(str(state), state)}{because}; "
            f"mcc recordings list {motor} shows what comes of it",
            details={"event_report": dict(request)},
        )
    if as_json:
        print_document(request)
        return
    diagnosis = request.get("diagnosis")
    if isinstance(diagnosis, Mapping):
        results().print(verdict_line(motor, diagnosis), soft_wrap=True)
    else:
        words = f"{motor}: recording request {request['id']}: {SO_FAR.get(str(state), state)}"
        results().print(Text(words), soft_wrap=True)
        results().print(Text(what_next("mcc trigger", motor)), soft_wrap=True)


def _joined(service: ServiceClient, request: Document, deadline_s: float) -> Document:
    """Return the request once its series was joined and that is diagnosed, or when the time is over."""
    while time.monotonic() < deadline_s:
        request = service.get_event_report(str(request["id"]))
        joined = request["joined_recording_id"]
        if joined is None and request["joined_remark"] is not None:
            break
        if joined is not None:
            found = service.get_recording(str(joined))
            if found["state"] in JOINED_ENDED:
                break
        time.sleep(POLL_PERIOD_S)
    remark = request["joined_remark"]
    if remark is not None:
        progress().print(Text(one_line(f"the series: {remark}"), style="yellow"), soft_wrap=True)
    return request


def release_relay(url: str, relay: str, *, as_json: bool) -> None:
    """End the quarantine of a relay. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        before = service.get_ied(relay)
        service.release_ied(relay)
        found = service.get_ied(relay)
    if as_json:
        print_document(found)
        return
    told = "was not set aside" if before["quarantine"] is None else "released, visited again within seconds"
    results().print(Text(f"{relay}: {told}"), soft_wrap=True)


def delete_recording(url: str, recording_id: str, reason: str, *, as_json: bool) -> None:
    """Delete a recording; who does can undo it for ten minutes. Raises CommandError."""
    if not reason.strip():
        raise CommandError("--reason: expected a few words, found none")
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        service.delete_recording(recording_id, reason=reason)
        deletion = service.get_deletion(recording_id)
    if as_json:
        print_document(deletion)
        return
    what = one_line(f"{deletion['motor']}: recording {deletion['name']} ({recording_id}) is deleted")
    results().print(Text(what), soft_wrap=True)


def _health(service: ServiceClient, motor: str) -> Document:
    return service.get_health(motor)


def _warn_of_a_link_that_is_down(service: ServiceClient, motor: str) -> None:
    """Print a warning where the relay does not answer: the request is stored, but may take long."""
    health = _health(service, motor)
    if health["link_state"] == "down":
        words = one_line(f"{motor}: the link to {health['ied']} is down: {health['link_reason']}")
        progress().print(Text(words, style="yellow"), soft_wrap=True)


def verdict_line(motor: str, diagnosis: Document) -> Text:
    """Return what a recording of a motor says, in one line."""
    line = Text(f"{motor}: ")
    line.append_text(verdict_text(str(diagnosis["verdict"]), _phase(diagnosis)))
    if diagnosis["mu_f"] is not None:
        line.append(f", {level(diagnosis['mu_f'], diagnosis['mu_f_ci95'])}, load {_load(diagnosis)}")
        line.append(f", detection limit {percent(diagnosis['detection_limit'])} %")
    else:
        line.append(one_line(f": {'; '.join(reasons_of(diagnosis))}"))
    return line


def _phase(diagnosis: Document) -> str:
    words = turns_phase_in_words(diagnosis)
    return f"in phase {words}" if words else ""


def _load(found: Document) -> str:
    return load(found["load_level"])
