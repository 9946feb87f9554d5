"""Who is limited to sites: routes x roles x sites, for things at another site and at their own.

The routes are those of the application. A new one that `site_rules` does not tell of is refused here, and one
that is listed there must show nothing of the other site.
"""

import io
import tempfile
import time
import uuid
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from fastapi.routing import iter_route_contexts

from core.condition.kinds import Kind
from service.access.permissions import PERMISSIONS_OF, Permission
from service.api import ApiContext
from service.api.access.requirements import requirement_of
from service.api.access.site_rules import KEYS, LISTED, LISTS, NO_SITE, WHOLE_PLANT, SiteRule, rule_of
from service.client.credentials import bearer
from service.configuration.settings import Settings
from service.plant import Plant, PlantMotor, Site
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import NewInspection, Role
from service.storage.repository.sites import AtSite
from service.storage.states import AlarmKind, InspectionOutcome
from service.web.app import create_site
from testing.service.accounts import TESTS, token_of
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, fault, motor, relay, two_motor_plant
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

A, B = "FACTORY_A", "QUARRY_B"
PUMP, CRUSHER = "PUMP-A1", "CRUSHER-B1"
RELAY_B = "B1_SEL710"
API = "/api/v1"
OPERATING = (Role.VIEWER, Role.OPERATOR, Role.ENGINEER)
QUERIES: Mapping[str, Mapping[str, str]] = {
    f"{API}/reports/alarms": {"format": "xlsx"},
    f"{API}/reports/fleet": {"format": "xlsx"},
    "/reports/alarms": {"format": "xlsx", "month": "2025-10"},
    "/reports/fleet": {"format": "xlsx"},
    "/reports/motor": {"format": "xlsx", "motor": CRUSHER},
    f"{API}/motors": {"health": "true"},
    "/search": {"text": "sel710"},
}
"""What routes are asked beside, so that they answer with all that they have."""

ACTING_LISTS = {
    (f"{API}/alarms/acknowledgements"),
    (f"{API}/alarms/acknowledgements/undo"),
    (f"{API}/recordings"),
    "/alarms/acknowledgements",
    "/alarms/acknowledgements/undo",
    "/recordings",
}
"""Routes that act on what their body names. What they refuse is tested below, one by one."""


@dataclass(frozen=True)
class There:
    """What there is at a site: the key of one thing of each kind."""

    keys: Mapping[AtSite, str]

    def path(self, template: str) -> str:
        """The path of a route, about what is there; what it has besides are ids of nothing."""
        for part, what in KEYS.items():
            if f"{part}/" in f"{template}/":
                name = part.partition("{")[2]
                template = template.replace(f"{{{name}", self.keys[what])
        while "{" in template:
            before, _, rest = template.partition("{")
            template = f"{before}{uuid.UUID(int=0)}{rest.partition('}')[2]}"
        return template


@dataclass(frozen=True)
class Places:
    """A service of two sites, and what is at each."""

    client: httpx.Client
    repository: Repository
    here: There
    there: There

    def as_(self, *roles: Role, sites: tuple[str, ...] | None = (A,)) -> Mapping[str, str]:
        """The headers of somebody with these roles at these sites."""
        name = f"somebody-{uuid.uuid4()}"
        self.repository.add_user(name, roles, password=None, sites=sites, by=TESTS, now_ns=time.time_ns())
        return bearer(token_of(self.repository, name=name))


def _two_sites() -> Plant:
    plant = two_motor_plant()
    return Plant(
        sites=(*plant.sites, Site(B, "Quarry")),
        relays=(*plant.relays, relay(RELAY_B, B, 10212)),
        motors=(*plant.motors, PlantMotor(motor(CRUSHER), "Crusher", B, RELAY_B)),
    )


def _things(repository: Repository, store: RecordingStore, name: str, its_relay: str) -> There:
    recording = add_diagnosed(repository, store, fault(), NOW_NS, motor=name, name="E1")
    gone = add_diagnosed(repository, store, fault(), NOW_NS + 1, motor=name, name="E2")
    repository.delete_recording(gone, "tested", by=TESTS, now_ns=NOW_NS + 2)
    request = repository.request_recording(name, by=TESTS, now_ns=NOW_NS)
    found = NewInspection(NOW_NS, Kind.NONE, "", InspectionOutcome.NOTHING_FOUND, "tested")
    repository.add_inspection(name, found, by=TESTS, now_ns=NOW_NS)
    alarm = repository.raise_alarm(its_relay, AlarmKind.FILE_REFUSED, f"{name}.CFG", "outside", now_ns=NOW_NS)
    return There(
        {
            AtSite.SITE: repository.motor(name).site,
            AtSite.MOTOR: name,
            AtSite.RELAY: its_relay,
            AtSite.RECORDING: recording,
            AtSite.RECORDING_REQUEST: request.id,
            AtSite.DELETION: gone,
            AtSite.ALARM: str(alarm.id),
        }
    )


@pytest.fixture
def places(
    repository: Repository, store: RecordingStore, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Places]:
    repository.sync_plant(_two_sites())
    here = _things(repository, store, PUMP, "A1_SEL710")
    there = _things(repository, store, CRUSHER, RELAY_B)
    settings = Settings(data_directory=tmp_path_factory.mktemp("data"))
    motors = {one.motor.name: one.motor for one in _two_sites().motors}
    context = ApiContext(settings, repository, store, motors=motors)
    with serving(create_site(context)) as client:
        yield Places(client, repository, here, there)


def _routes() -> Iterator[tuple[str, str, Role, SiteRule]]:
    """Each route, with each operating role that has its permission."""
    for method, path, needed, rule in _ROUTES:
        for role in OPERATING:
            if needed in PERMISSIONS_OF[role]:
                yield method, path, role, rule


def _all_routes() -> list[tuple[str, str, Permission | None, SiteRule]]:
    """Each route of the application, with its permission and what it is about."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        unused = Repository(connect(f"sqlite:///{folder / 'unused.sqlite'}"))
        site = create_site(ApiContext(Settings(data_directory=folder), unused, FolderStore(folder / "r")))
        found: list[tuple[str, str, Permission | None, SiteRule]] = []
        for route in iter_route_contexts(site.routes):
            needed = requirement_of(route.dependencies)
            rule = rule_of(str(route.path), needed)
            found.extend((method, str(route.path), needed, rule) for method in sorted(route.methods or ()))
        return found


_ROUTES = _all_routes()


def test_each_listed_path_is_a_route_and_those_that_act_are_tested() -> None:
    paths = {path for _, path, _, _ in _ROUTES}
    assert paths >= LISTS
    acting = {path for method, path, _, rule in _ROUTES if rule == LISTED and method not in ("GET", "HEAD")}
    assert acting == ACTING_LISTS, (
        "a route that acts on what its body names asks `demand_here`; test it below"
    )
    assert all(any(f"{part}/" in f"{path}/" for path in paths) for part in KEYS)


def test_what_is_at_another_site_is_forbidden_to_every_role(places: Places) -> None:
    headers = {role: places.as_(role) for role in OPERATING}
    refused = 0
    for method, path, role, rule in _routes():
        if not isinstance(rule, AtSite):
            continue
        where = places.there.path(path)
        answer = places.client.request(method, where, headers=headers[role])
        assert answer.status_code == 403, (role, method, where, answer.text)
        refused += 1
        if role is not Role.ENGINEER:
            continue
        nobody = _of_nothing(path)
        answer = places.client.request(method, nobody, headers=headers[role])
        assert answer.status_code != 403, "what there is not is not found, as for everybody"
    assert refused > 100
    with places.repository.audit_trail() as trail:
        told = [entry for entry in trail.entries() if entry.action == "request-refused"]
    assert told, "the audit trail tells of attempts"


def _of_nothing(path: str) -> str:
    """A path about things that there are not."""
    nothing = There(
        {
            what: "NOBODY" if what in (AtSite.SITE, AtSite.MOTOR, AtSite.RELAY) else str(uuid.UUID(int=1))
            for what in AtSite
        }
    )
    return nothing.path(path)


def test_what_is_about_the_whole_plant_is_forbidden_to_every_role(places: Places) -> None:
    headers = {role: places.as_(role) for role in OPERATING}
    paths = set()
    for method, path, role, rule in _routes():
        if rule == WHOLE_PLANT:
            answer = places.client.request(method, _of_nothing(path), headers=headers[role])
            assert answer.status_code == 403, (role, method, path)
            paths.add(path)
    assert {"/metrics", f"{API}/gateways", f"{API}/backups", "/notifications"} <= paths


def _text(answer: httpx.Response) -> str:
    if not answer.content.startswith(b"PK"):
        return answer.text
    with zipfile.ZipFile(io.BytesIO(answer.content)) as book:
        return "".join(book.read(name).decode("utf-8", "replace") for name in book.namelist())


@pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)
def test_lists_leave_out_what_is_at_another_site(places: Places) -> None:
    limited, whole = places.as_(Role.ENGINEER), places.as_(Role.ENGINEER, sites=None)
    hidden = (B, CRUSHER, RELAY_B, *places.there.keys.values())
    seen = set()
    for method, path, role, rule in _routes():
        if rule != LISTED or method != "GET" or role is not Role.ENGINEER or path == "/live":
            continue
        query = QUERIES.get(path, {})
        answer = places.client.get(path, params=query, headers=limited)
        assert answer.status_code == (404 if path == "/reports/motor" else 200), (path, answer.text)
        found = [word for word in hidden if word in _text(answer)]
        asked = {CRUSHER} if path == "/reports/motor" else set()  # the answer tells what was asked for
        assert set(found) <= asked, (path, found)
        everything = _text(places.client.get(path, params=query, headers=whole))
        if any(word in everything for word in hidden):
            seen.add(path)
    empty = {f"{API}/exports/starts", f"{API}/exports/measurements", "/reports", "/starts"}
    quiet = {f"{API}/alarms/figures", f"{API}/reports/alarms", "/reports/alarms"}
    assert seen >= LISTS - ACTING_LISTS - empty - quiet - {"/live"}, "else the test shows nothing"


def test_what_is_at_the_own_site_is_answered_as_ever(places: Places) -> None:
    for role in OPERATING:
        headers = places.as_(role)
        for method, path, needed, rule in _ROUTES:
            if isinstance(rule, AtSite) and needed in PERMISSIONS_OF[role] and method == "GET":
                answer = places.client.get(places.here.path(path), headers=headers)
                assert answer.status_code not in (401, 403, 500), (role, path, answer.text)
    operator = places.as_(Role.OPERATOR)
    assert places.client.post(f"{API}/motors/{PUMP}/event-reports", headers=operator).status_code == 202
    noted = places.client.post(f"{API}/motors/{PUMP}/notes", json={"text": "noisy"}, headers=operator)
    assert noted.status_code == 201
    alarm = places.here.keys[AtSite.ALARM]
    assert places.client.post(f"{API}/alarms/{alarm}/acknowledgements", headers=operator).status_code == 200


@pytest.mark.parametrize("form", ["{}", "{{{}}}", "urn:uuid:{}", "upper", "simple"])
def test_no_other_form_of_an_id_gets_past(places: Places, form: str) -> None:
    alarm = places.there.keys[AtSite.ALARM]
    written = {"upper": alarm.upper(), "simple": alarm.replace("-", "")}.get(form) or form.format(alarm)
    refused = places.client.post(
        f"{API}/alarms/{written}/acknowledgements", headers=places.as_(Role.OPERATOR)
    )
    assert refused.status_code == 403, refused.text
    assert places.repository.alarm(alarm).state == "unacknowledged"


def test_what_a_body_names_at_another_site_is_forbidden(places: Places) -> None:
    engineer = places.as_(Role.ENGINEER)
    there, here = places.there.keys, places.here.keys
    files = [("files", ("U1.CFF", b"an upload"))]
    for path in (f"{API}/recordings", "/recordings"):
        answer = places.client.post(path, data={"motor": CRUSHER}, files=files, headers=engineer)
        assert answer.status_code == 403, answer.text
    both = [here[AtSite.ALARM], there[AtSite.ALARM]]
    answer = places.client.post(f"{API}/alarms/acknowledgements", json={"alarms": both}, headers=engineer)
    assert answer.status_code == 403
    answer = places.client.post("/alarms/acknowledgements", data={"alarm": both}, headers=engineer)
    assert answer.status_code == 403
    undo = f"{API}/alarms/acknowledgements/undo"
    assert places.client.post(undo, json={"alarms": both}, headers=engineer).status_code == 403
    form = places.client.post("/alarms/acknowledgements/undo", data={"alarm": both}, headers=engineer)
    assert form.status_code == 403
    assert {places.repository.alarm(one).state for one in both} == {"unacknowledged"}, "none of them"
    again = {"recording": there[AtSite.RECORDING]}
    answer = places.client.post(f"/motors/{PUMP}/diagnoses", data=again, headers=engineer)
    assert answer.status_code == 403
    answer = places.client.get("/live", params={"topic": f"motor:{CRUSHER}"}, headers=engineer)
    assert answer.status_code == 403
    wrong = [("files", ("U1.EXE", b"no recording"))]
    form = places.client.post("/recordings", data={"motor": PUMP}, files=wrong, headers=engineer)
    assert form.status_code == 422
    assert CRUSHER not in form.text, "the form that comes back offers motors of the own sites alone"
    baseline = {"recording_ids": [there[AtSite.RECORDING]] * 3}
    answer = places.client.put(f"{API}/motors/{PUMP}/baseline", json=baseline, headers=engineer)
    assert answer.is_client_error
    for path in (f"{API}/recordings", f"{API}/event-reports", f"{API}/deletions", f"{API}/exports/trend"):
        answer = places.client.get(path, params={"motor": CRUSHER}, headers=engineer)
        assert answer.status_code == 404, path


def test_a_token_is_for_no_more_sites_than_who_makes_it(places: Places) -> None:
    tokens = f"{API}/account/tokens"
    everywhere = places.as_(Role.OPERATOR, sites=None)
    narrow = places.client.post(tokens, json={"label": "a", "sites": [A]}, headers=everywhere).json()
    assert narrow["sites"] == [A]
    headers = bearer(narrow["token"])
    trigger = f"{API}/motors/{CRUSHER}/event-reports"
    assert places.client.post(trigger, headers=headers).status_code == 403
    assert places.client.get(f"{API}/account", headers=headers).json()["sites"] == [A]
    child = places.client.post(tokens, json={"label": "child"}, headers=headers).json()
    assert child["sites"] == [A]
    assert places.client.post(trigger, headers=bearer(child["token"])).status_code == 403
    for wider in ([B], [A, B]):
        wanted = {"label": "wide", "sites": wider}
        assert places.client.post(tokens, json=wanted, headers=headers).status_code == 422
    limited = places.as_(Role.OPERATOR)
    assert places.client.post(tokens, json={"label": "x", "sites": [B]}, headers=limited).status_code == 422
    own = places.client.post(tokens, json={"label": "own"}, headers=limited).json()
    assert places.client.post(trigger, headers=bearer(own["token"])).status_code == 403


def test_other_sites_hold_at_once_and_who_is_limited_widens_nothing(places: Places) -> None:
    admin = places.as_(Role.SECADM, sites=None)
    made = {"name": "olga", "roles": ["OPERATOR"], "sites": [A]}
    assert places.client.post(f"{API}/users", json=made, headers=admin).json()["sites"] == [A]
    olga = bearer(token_of(places.repository, name="olga"))
    trigger = f"{API}/motors/{CRUSHER}/event-reports"
    assert places.client.post(trigger, headers=olga).status_code == 403
    user = f"{API}/users/olga"
    assert places.client.patch(user, json={"all_sites": True}, headers=olga).status_code == 403
    assert places.client.patch(user, json={"full_name": "Olga"}, headers=admin).json()["sites"] == [A]
    assert places.client.patch(user, json={"sites": None}, headers=admin).json()["sites"] == [A]
    both = {"sites": [B], "all_sites": True}
    assert places.client.patch(user, json=both, headers=admin).status_code == 422
    assert places.client.patch(user, json={"sites": [B]}, headers=admin).json()["sites"] == [B]
    assert places.client.post(trigger, headers=olga).status_code == 202
    assert places.client.patch(user, json={"all_sites": True}, headers=admin).json()["sites"] is None
    changed = places.client.patch(user, json={"sites": []}, headers=admin).json()
    assert changed["sites"] == [], "no site at all, not all of them"
    assert places.client.get(f"{API}/motors", headers=olga).json()["items"] == []
    with places.repository.audit_trail() as trail:
        entries = [one for one in trail.entries() if one.action == "user-changed"]
    assert len(entries) >= 4


def test_people_are_managed_at_no_site(places: Places) -> None:
    limited = places.as_(Role.SECADM, Role.ENGINEER)
    for path in (f"{API}/users", f"{API}/account", "/people", "/account"):
        assert places.client.get(path, headers=limited).status_code == 200
    rules = {rule for _, path, _, rule in _ROUTES if path.startswith((f"{API}/users", "/people", "/account"))}
    assert rules == {NO_SITE}
