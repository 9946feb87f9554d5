"""Every form that changes something leaves an entry that names who sent it; a new one has to be told here."""

from collections.abc import Iterator

import httpx
import pytest
from fastapi.routing import iter_route_contexts

from service.web.app import create_site
from testing.service.pictures import SMALL_PNG
from tests.core.relay_reports.examples import SER
from tests.docs.role_tables import is_page
from tests.service.audited import API, INSPECTION, ME, PASSWORD, Changes, Prepared, audited_service, sent

MOTOR = "/motors/PUMP-A1"


def _own(path: str) -> str:
    """Return the page of what a path of the API is about."""
    return path.removeprefix(API).replace("/users/", "/people/")


def _login(it: Prepared) -> httpx.Response:
    form = {"name": it.person(), "password": PASSWORD}
    return httpx.post(f"{it.client.base_url}/login", data=form, trust_env=False, timeout=30)


def _logout(it: Prepared) -> httpx.Response:
    return httpx.post(f"{it.client.base_url}/logout", cookies=it.login().cookies, trust_env=False, timeout=30)


def _password(it: Prepared) -> httpx.Response:
    new = f"{PASSWORD} staple"
    form = {"old": PASSWORD, "new": new, "again": new}
    return it.client.post("/account/password", data=form, headers=it.bearer_of(it.person()))


AGAIN = {"password": PASSWORD}
PICTURE = {"pictures": ("a.png", SMALL_PNG)}


FORMS: Changes = {
    "POST /login": (_login, "logged-in"),
    "POST /logout": (_logout, "logged-out"),
    "POST /alarms/acknowledgements": (
        lambda it: it.client.post("/alarms/acknowledgements", data={"alarm": it.alarm().rpartition("/")[2]}),
        "alarm-acknowledged",
    ),
    "POST /alarms/acknowledgements/undo": (
        lambda it: it.client.post("/alarms/acknowledgements/undo", data={"alarm": it.acknowledged()}),
        "alarm-acknowledgement-undone",
    ),
    "POST /alarms/{alarm_id}/acknowledgement": (
        lambda it: it.client.post(f"{_own(it.alarm())}/acknowledgement"),
        "alarm-acknowledged",
    ),
    "POST /alarms/{alarm_id}/shelving": (
        lambda it: it.client.post(f"{_own(it.alarm())}/shelving", data={"hours": 24}),
        "alarm-shelved",
    ),
    "POST /alarms/{alarm_id}/unshelving": (
        lambda it: it.client.post(f"{_own(it.shelved())}/unshelving"),
        "alarm-unshelved",
    ),
    "POST /alarms/{alarm_id}/out-of-service": (
        lambda it: it.client.post(f"{_own(it.alarm())}/out-of-service"),
        "alarm-taken-out-of-service",
    ),
    "POST /alarms/{alarm_id}/back-in-service": (
        lambda it: it.client.post(f"{_own(it.out_of_service())}/back-in-service"),
        "alarm-put-back-in-service",
    ),
    "POST /relays/{name}/release": (
        lambda it: it.client.post(
            f"{it.quarantined().removesuffix('/quarantine').replace(f'{API}/ieds', '/relays')}/release"
        ),
        "quarantine-released",
    ),
    "POST /account/password": (_password, "password-set"),
    "POST /account/totp": (
        lambda it: it.in_session("/account/totp", data=AGAIN),
        "second-factor-begun",
    ),
    "POST /account/totp/confirmation": (
        lambda it: it.in_session("/account/totp/confirmation", code=True, data=AGAIN),
        "second-factor-added",
    ),
    "POST /account/recovery-codes": (
        lambda it: it.in_session("/account/recovery-codes", with_app=True, data=AGAIN),
        "recovery-codes-made",
    ),
    "POST /account/passkeys": (
        lambda it: it.with_passkey("/account/passkeys", data=AGAIN),
        "second-factor-added",
    ),
    "POST /account/passkeys/{passkey_id}/removal": (
        lambda it: it.with_passkey("/account/passkeys/{passkey_id}/removal", added=True, data=AGAIN),
        "second-factor-removed",
    ),
    "POST /account/second-factor/removal": (
        lambda it: it.in_session("/account/second-factor/removal", with_app=True, data=AGAIN),
        "second-factor-removed",
    ),
    "POST /people/{name}/second-factor/reset": (
        lambda it: it.client.post(f"{_own(it.user())}/second-factor/reset"),
        "second-factor-reset",
    ),
    "POST /account/tokens": (
        lambda it: it.client.post("/account/tokens", data={"label": "a test"}),
        "token-added",
    ),
    "POST /account/tokens/{token_id}/revocation": (
        lambda it: it.client.post(f"/account/tokens/{it.token()}/revocation"),
        "token-revoked",
    ),
    "POST /recordings/{recording_id}/deletion": (
        lambda it: it.client.post(f"/recordings/{it.recording()}/deletion", data={"reason": "a test"}),
        "recording-deleted",
    ),
    "POST /deletions/{recording_id}/undo": (
        lambda it: it.client.post(f"/deletions/{it.deleted()}/undo"),
        "recording-deletion-undone",
    ),
    "POST /people": (
        lambda it: it.client.post("/people", data={"name": "sam", "roles": ["VIEWER"]}),
        "user-added",
    ),
    "POST /people/{name}": (
        lambda it: it.client.post(_own(it.user()), data={"roles": ["OPERATOR"]}),
        "user-changed",
    ),
    "POST /people/{name}/password": (
        lambda it: it.client.post(f"{_own(it.user())}/password", data={"password": PASSWORD}),
        "password-set",
    ),
    "POST /people/{name}/sessions-end": (
        lambda it: it.client.post(f"{_own(it.user())}/sessions-end"),
        "sessions-ended",
    ),
    "POST /people/{name}/unlocking": (
        lambda it: it.client.post(f"{_own(it.user())}/unlocking"),
        "user-unlocked",
    ),
    "POST /people/{name}/deletion": (
        lambda it: it.client.post(f"{_own(it.user())}/deletion"),
        "user-deleted",
    ),
    "POST /account/tokens-end": (
        lambda it: it.client.post("/account/tokens-end", headers=it.somebody()),
        "tokens-revoked",
    ),
    "POST /people/{name}/tokens-end": (
        lambda it: it.client.post(f"{_own(it.user_with_token())}/tokens-end"),
        "tokens-revoked",
    ),
    "POST /people/{name}/tokens/{token_id}/revocation": (
        lambda it: it.client.post(f"/people/{ME}/tokens/{it.token()}/revocation"),
        "token-revoked",
    ),
    "POST /motors/{name}/recording-requests": (
        lambda it: it.client.post(f"{MOTOR}/recording-requests"),
        "recording-requested",
    ),
    "POST /motors/{name}/diagnoses": (
        lambda it: it.client.post(f"{MOTOR}/diagnoses", data={"recording": it.recording()}),
        "diagnosis-requested",
    ),
    "POST /motors/{name}/reference": (
        lambda it: it.client.post(f"{MOTOR}/reference", data={"reason": "tested"}),
        "reference-restarted",
    ),
    "POST /motors/{name}/notes": (
        lambda it: it.client.post(f"{MOTOR}/notes", data={"text": "a note"}),
        "note-added",
    ),
    "POST /motors/{name}/notes/{note_id}/withdrawal": (
        lambda it: it.client.post(f"{MOTOR}/notes/{it.note()}/withdrawal", data={"reason": "wrong motor"}),
        "note-withdrawn",
    ),
    "POST /motors/{name}/notes/{note_id}/undo": (
        lambda it: it.client.post(f"{MOTOR}/notes/{it.note(kind='maintenance')}/undo"),
        "note-withdrawn",
    ),
    "POST /motors/{name}/planned-stop": (
        lambda it: it.client.post(f"{MOTOR}/planned-stop", data={"time": "2090-12-24T06:00"}),
        "stop-planned",
    ),
    "POST /motors/{name}/planned-stop/cancellation": (
        lambda it: it.client.post(f"{MOTOR}/planned-stop/cancellation", data={"of": "site"}),
        "stop-cancelled",
    ),
    "POST /motors/{name}/inspections": (
        lambda it: it.client.post(
            f"{MOTOR}/inspections", data=INSPECTION, files={"pictures": ("a.png", SMALL_PNG)}
        ),
        "inspection-added",
    ),
    "POST /motors/{name}/inspections/{inspection_id}/withdrawal": (
        lambda it: it.client.post(f"{_own(it.inspection())}/withdrawal", data={"reason": "wrong motor"}),
        "inspection-withdrawn",
    ),
    "POST /motors/{name}/reports": (
        lambda it: it.client.post(f"{MOTOR}/reports", files={"report": ("SER.TXT", SER.encode())}),
        "report-imported",
    ),
    "POST /notifications/channels/{name}/test": (
        lambda it: it.client.post("/notifications/channels/hook/test"),
        "channel-tested",
    ),
    "POST /notifications/{notification_id}/attempt": (
        lambda it: it.client.post(f"{_own(it.given_up())}/attempt"),
        "notification-retried",
    ),
    "POST /recordings": (
        lambda it: it.client.post("/recordings", data={"motor": "PUMP-A1"}, files=it.files()),
        "recording-uploaded",
    ),
    "POST /recordings/{recording_id}/diagnoses": (
        lambda it: it.client.post(f"/recordings/{it.recording()}/diagnoses"),
        "diagnosis-requested",
    ),
}


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Prepared]:
    with audited_service(tmp_path_factory.mktemp("audited"), create_site) as prepared:
        yield prepared


def test_every_form_is_told(prepared: Prepared) -> None:
    forms = {
        f"{method} {route.path}"
        for route in iter_route_contexts(prepared.app.routes)
        for method in set(route.methods or ()) - {"GET", "HEAD"}
        if is_page(str(route.path))
    }
    assert forms == set(FORMS), "tell of each form how it is sent with success"


@pytest.mark.parametrize("form", FORMS)
def test_a_form_leaves_an_entry(prepared: Prepared, form: str) -> None:
    assert sent(prepared, FORMS, form).status_code in (200, 303)
