"""Every route that changes something leaves an entry that names who asked; a new one has to be told here."""

from collections.abc import Iterator

import pytest

from service.api import create_app
from testing.service.accounts import auditor
from testing.service.pictures import SMALL_PNG
from tests.core.relay_reports.examples import MSR
from tests.service.audited import (
    API,
    INSPECTION,
    MOTOR,
    PASSWORD,
    SHELVED,
    Changes,
    Prepared,
    audited_service,
    sent,
)

CHANGING = {"post", "put", "patch", "delete"}

AGAIN = {"password": PASSWORD}
SITE = "FACTORY_A"


REQUESTS: Changes = {
    "POST /api/v1/motors/{name}/event-reports": (
        lambda it: it.client.post(f"{MOTOR}/event-reports"),
        "recording-requested",
    ),
    "POST /api/v1/motors/{name}/notes": (
        lambda it: it.client.post(f"{MOTOR}/notes", json={"text": "a note"}),
        "note-added",
    ),
    "POST /api/v1/motors/{name}/notes/{note_id}/withdrawal": (
        lambda it: it.client.post(f"{MOTOR}/notes/{it.note()}/withdrawal", json={"reason": "wrong motor"}),
        "note-withdrawn",
    ),
    "POST /api/v1/motors/{name}/reference": (
        lambda it: it.client.post(f"{MOTOR}/reference", json={"reason": "tested"}),
        "reference-restarted",
    ),
    "PUT /api/v1/motors/{name}/planned-stop": (
        lambda it: it.client.put(f"{MOTOR}/planned-stop", json={"time": "2090-12-24"}),
        "stop-planned",
    ),
    "DELETE /api/v1/motors/{name}/planned-stop": (
        lambda it: it.client.delete(f"{MOTOR}/planned-stop"),
        "stop-cancelled",
    ),
    "PUT /api/v1/sites/{name}/planned-stop": (
        lambda it: it.client.put(f"{API}/sites/{SITE}/planned-stop", json={"time": "2090-12-24"}),
        "stop-planned",
    ),
    "DELETE /api/v1/sites/{name}/planned-stop": (
        lambda it: it.client.delete(f"{API}/sites/{SITE}/planned-stop"),
        "stop-cancelled",
    ),
    "POST /api/v1/motors/{name}/inspections": (
        lambda it: it.client.post(f"{MOTOR}/inspections", json=INSPECTION),
        "inspection-added",
    ),
    "POST /api/v1/motors/{name}/inspections/{inspection_id}/pictures": (
        lambda it: it.client.post(
            f"{it.inspection()}/pictures",
            content=SMALL_PNG,
            headers={"Content-Type": "application/octet-stream"},
        ),
        "inspection-added",
    ),
    "POST /api/v1/motors/{name}/inspections/{inspection_id}/withdrawal": (
        lambda it: it.client.post(f"{it.inspection()}/withdrawal", json={"reason": "wrong motor"}),
        "inspection-withdrawn",
    ),
    "PUT /api/v1/motors/{name}/baseline": (
        lambda it: it.client.put(f"{MOTOR}/baseline", json=it.baseline()),
        "baseline-set",
    ),
    "DELETE /api/v1/motors/{name}/baseline": (
        lambda it: it.client.delete(it.chosen_baseline()),
        "baseline-deleted",
    ),
    "DELETE /api/v1/ieds/{name}/quarantine": (
        lambda it: it.client.delete(it.quarantined()),
        "quarantine-released",
    ),
    "POST /api/v1/alarms/acknowledgements": (
        lambda it: it.client.post(
            f"{API}/alarms/acknowledgements", json={"alarms": [it.alarm().rpartition("/")[2]]}
        ),
        "alarm-acknowledged",
    ),
    "POST /api/v1/alarms/acknowledgements/undo": (
        lambda it: it.client.post(
            f"{API}/alarms/acknowledgements/undo", json={"alarms": [it.acknowledged()]}
        ),
        "alarm-acknowledgement-undone",
    ),
    "POST /api/v1/motors/{name}/notes/{note_id}/undo": (
        lambda it: it.client.post(f"{MOTOR}/notes/{it.note('maintenance')}/undo"),
        "note-withdrawn",
    ),
    "POST /api/v1/alarms/{alarm_id}/acknowledgements": (
        lambda it: it.client.post(f"{it.alarm()}/acknowledgements"),
        "alarm-acknowledged",
    ),
    "PUT /api/v1/alarms/{alarm_id}/shelving": (
        lambda it: it.client.put(f"{it.alarm()}/shelving", json=SHELVED),
        "alarm-shelved",
    ),
    "DELETE /api/v1/alarms/{alarm_id}/shelving": (
        lambda it: it.client.delete(f"{it.shelved()}/shelving"),
        "alarm-unshelved",
    ),
    "PUT /api/v1/alarms/{alarm_id}/out-of-service": (
        lambda it: it.client.put(f"{it.alarm()}/out-of-service"),
        "alarm-taken-out-of-service",
    ),
    "DELETE /api/v1/alarms/{alarm_id}/out-of-service": (
        lambda it: it.client.delete(f"{it.out_of_service()}/out-of-service"),
        "alarm-put-back-in-service",
    ),
    "POST /api/v1/notification-channels/{name}/tests": (
        lambda it: it.client.post(f"{API}/notification-channels/hook/tests"),
        "channel-tested",
    ),
    "POST /api/v1/notifications/{notification_id}/attempts": (
        lambda it: it.client.post(f"{it.given_up()}/attempts"),
        "notification-retried",
    ),
    "POST /api/v1/recordings": (
        lambda it: it.client.post(f"{API}/recordings", data={"motor": "PUMP-A1"}, files=it.files()),
        "recording-uploaded",
    ),
    "POST /api/v1/motors/{name}/reports": (
        lambda it: it.client.post(f"{MOTOR}/reports", content=MSR, headers={"Content-Type": "text/plain"}),
        "report-imported",
    ),
    "DELETE /api/v1/recordings/{recording_id}": (
        lambda it: it.client.delete(f"{API}/recordings/{it.recording()}", params={"reason": "a test"}),
        "recording-deleted",
    ),
    "POST /api/v1/deletions/{recording_id}/undo": (
        lambda it: it.client.post(f"{API}/deletions/{it.deleted()}/undo"),
        "recording-deletion-undone",
    ),
    "POST /api/v1/recordings/{recording_id}/diagnoses": (
        lambda it: it.client.post(f"{API}/recordings/{it.recording()}/diagnoses"),
        "diagnosis-requested",
    ),
    "POST /api/v1/login": (lambda it: it.login(), "logged-in"),
    "POST /api/v1/logout": (lambda it: it.logout(), "logged-out"),
    "PUT /api/v1/account/password": (lambda it: it.other_password(), "password-set"),
    "POST /api/v1/account/totp": (
        lambda it: it.in_session(f"{API}/account/totp", json=AGAIN),
        "second-factor-begun",
    ),
    "POST /api/v1/account/totp/confirmation": (
        lambda it: it.in_session(f"{API}/account/totp/confirmation", code=True, json=AGAIN),
        "second-factor-added",
    ),
    "POST /api/v1/account/recovery-codes": (
        lambda it: it.in_session(f"{API}/account/recovery-codes", with_app=True, json=AGAIN),
        "recovery-codes-made",
    ),
    "POST /api/v1/account/passkeys/options": (
        lambda it: it.in_session(f"{API}/account/passkeys/options", json=AGAIN),
        "second-factor-begun",
    ),
    "POST /api/v1/account/passkeys": (
        lambda it: it.with_passkey(f"{API}/account/passkeys", json=AGAIN),
        "second-factor-added",
    ),
    "POST /api/v1/account/passkeys/{passkey_id}/removal": (
        lambda it: it.with_passkey(f"{API}/account/passkeys/{{passkey_id}}/removal", added=True, json=AGAIN),
        "second-factor-removed",
    ),
    "POST /api/v1/account/second-factor/removal": (
        lambda it: it.in_session(f"{API}/account/second-factor/removal", with_app=True, json=AGAIN),
        "second-factor-removed",
    ),
    "POST /api/v1/users/{name}/second-factor/reset": (
        lambda it: it.client.post(f"{it.user()}/second-factor/reset"),
        "second-factor-reset",
    ),
    "POST /api/v1/account/tokens": (
        lambda it: it.client.post(f"{API}/account/tokens", json={"label": "a test"}),
        "token-added",
    ),
    "DELETE /api/v1/account/tokens/{token_id}": (
        lambda it: it.client.delete(f"{API}/account/tokens/{it.token()}"),
        "token-revoked",
    ),
    "DELETE /api/v1/tokens/{token_id}": (
        lambda it: it.client.delete(f"{API}/tokens/{it.token()}"),
        "token-revoked",
    ),
    "POST /api/v1/users": (
        lambda it: it.client.post(f"{API}/users", json={"name": "new", "roles": ["VIEWER"]}),
        "user-added",
    ),
    "PATCH /api/v1/users/{name}": (
        lambda it: it.client.patch(it.user(), json={"roles": ["OPERATOR"]}),
        "user-changed",
    ),
    "PUT /api/v1/users/{name}/password": (
        lambda it: it.client.put(f"{it.user()}/password", json={"password": PASSWORD}),
        "password-set",
    ),
    "DELETE /api/v1/users/{name}/sessions": (
        lambda it: it.client.delete(f"{it.user()}/sessions"),
        "sessions-ended",
    ),
    "DELETE /api/v1/users/{name}/lock": (lambda it: it.client.delete(f"{it.user()}/lock"), "user-unlocked"),
    "DELETE /api/v1/users/{name}": (lambda it: it.client.delete(it.user()), "user-deleted"),
    "DELETE /api/v1/account/tokens": (
        lambda it: it.client.delete(f"{API}/account/tokens", headers=it.somebody()),
        "tokens-revoked",
    ),
    "DELETE /api/v1/users/{name}/tokens": (
        lambda it: it.client.delete(it.user_with_token() + "/tokens"),
        "tokens-revoked",
    ),
}


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Prepared]:
    with audited_service(tmp_path_factory.mktemp("audited"), create_app) as prepared:
        yield prepared


def test_every_changing_route_is_told(prepared: Prepared) -> None:
    document = prepared.client.get(f"{API}/openapi.json").json()
    changing = {
        f"{method.upper()} {path}"
        for path, methods in document["paths"].items()
        for method in CHANGING.intersection(methods)
    }
    assert changing == set(REQUESTS), "tell of each route that changes something how a request succeeds"


@pytest.mark.parametrize("route", REQUESTS)
def test_a_changing_route_leaves_an_entry(prepared: Prepared, route: str) -> None:
    assert sent(prepared, REQUESTS, route).is_success


def test_a_route_that_reads_leaves_none(prepared: Prepared) -> None:
    reads = auditor(prepared.repository)
    before = prepared.client.get(f"{API}/audit/head", headers=reads).json()
    document = prepared.client.get(f"{API}/openapi.json").json()
    for path in document["paths"]:
        headers = reads if path.startswith(f"{API}/audit/") else {}
        answer = prepared.client.get(path.replace("{name}", "PUMP-A1"), headers=headers)
        assert answer.status_code != 403, f"{path}: a refusal leaves an entry"
    assert prepared.client.get(f"{API}/audit/head", headers=reads).json() == before
