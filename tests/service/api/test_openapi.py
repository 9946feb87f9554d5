"""The API is what its OpenAPI document says: requests made from the document, answers checked against it."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from schemathesis import BaseSchema, Case, GenerationMode
from schemathesis.core.result import Ok
from schemathesis.schemas import APIOperation
from schemathesis.specs.openapi.checks import negative_data_rejection, positive_data_acceptance

from service.access.bearer_secrets import digest_of
from service.api import ApiContext, create_app
from service.client.credentials import bearer
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.records import Role, Sample
from service.storage.states import AlarmKind, LinkState
from testing.service.accounts import token_of
from testing.service.conditions import FAULT, tell
from testing.service.database import make_database
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.links import set_link_state
from testing.service.observations import OBSERVATION
from testing.service.plants import NOW_NS, fault, two_motor_plant
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import serving

EVERYBODY = "all roles"


NOBODY = "nobody"
WHO = (NOBODY, *(role.value for role in Role))
MOST = settings(deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@dataclass(frozen=True)
class Api:
    """The document of a running API, and who asks: EVERYBODY, somebody of one role, NOBODY."""

    schema: BaseSchema
    repository: Repository
    secrets: dict[str, str]

    def headers(self, who: str) -> dict[str, str]:
        """Return the headers of who asks, with another token where a request has ended theirs."""
        if who == NOBODY:
            return {}
        secret = self.secrets.get(who)
        if secret is None or self.repository.token_with(digest_of(secret)) is None:
            asks = () if who == EVERYBODY else (Role(who),)
            secret = token_of(self.repository, *asks, name=who.lower().replace(" ", "-"))
            self.secrets[who] = secret
        return dict(bearer(secret))

    def operations(self) -> Iterator[APIOperation[Any, Any, Any, Any]]:
        """Every operation of the document."""
        for result in self.schema.get_all_operations():
            assert isinstance(result, Ok), result
            yield result.ok()


@pytest.fixture(scope="module")
def documented_api(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Api]:
    """A running API with something in every table."""
    data: Path = tmp_path_factory.mktemp("api")
    engine = connect(make_database(data))
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    store = FolderStore(data / "recordings")
    register_runner(repository)
    report = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    stored = store.store({"EVENT.CFG": CFG, "EVENT.DAT": DAT})
    repository.add_recording(stored, motor="PUMP-A1", recording_request_id=report.id, now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id,
        findings_of(fault(), observation=OBSERVATION),
        recorded_ns=NOW_NS,
        now_ns=NOW_NS,
        runner=RUNNER,
    )
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, "refused", now_ns=NOW_NS)
    repository.register_gateway("here/0", host="here", process_id=1, now_ns=NOW_NS)
    repository.share_relays("here/0", ["A1_SEL710"], most=1, problem=None)
    repository.add_samples([Sample("PUMP-A1", NOW_NS, {"ia_A": 1.0})])
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "X.CFG", "outside", now_ns=NOW_NS)
    tell(repository, FAULT)
    context = ApiContext(Settings(data_directory=data), repository, store)
    with serving(create_app(context)) as client:
        everybody = {"Authorization": client.headers["Authorization"]}
        schema = schemathesis.openapi.from_url(f"{client.base_url}/api/v1/openapi.json", headers=everybody)
        yield Api(schema, repository, {})
    engine.dispose()


def takes_anything(operation: APIOperation[Any, Any, Any, Any]) -> bool:
    """Whether no request can be wrong: it has nothing, or no more than a name in its path."""
    told = operation.definition.raw
    return "requestBody" not in told and all(
        (one["in"], one["name"]) == ("path", "name") for one in told.get("parameters", ())
    )


@pytest.mark.timeout(300)
@pytest.mark.parametrize("mode", [GenerationMode.POSITIVE, GenerationMode.NEGATIVE])
def test_answers_are_as_documented(documented_api: Api, mode: GenerationMode) -> None:
    for operation in documented_api.operations():
        if mode is GenerationMode.NEGATIVE and takes_anything(operation):
            continue

        @given(case=operation.as_strategy(generation_mode=mode))
        @settings(MOST, max_examples=6)
        def answers_as_documented(case: Case[Any]) -> None:
            answer = case.call(headers=documented_api.headers(EVERYBODY))
            # A cursor or a file name that fits its schema need not be one of ours: 422 is an answer too. One
            # whose body is too large (413) is refused before anybody looks what is in it.
            is_too_large = [negative_data_rejection] if answer.status_code == 413 else []
            case.validate_response(answer, excluded_checks=[positive_data_acceptance, *is_too_large])

        answers_as_documented()


@pytest.mark.parametrize("who", WHO)
@pytest.mark.parametrize(
    "examples", [1, pytest.param(25, marks=[pytest.mark.campaign, pytest.mark.timeout(900)])]
)
def test_whoever_asks_whatever_nothing_fails(documented_api: Api, who: str, examples: int) -> None:
    """What a role may do is another matter: no request fails the service, and every refusal is a problem."""
    answered: Counter[int] = Counter()
    for operation in documented_api.operations():

        @given(case=operation.as_strategy(generation_mode=GenerationMode.POSITIVE))
        @settings(MOST, max_examples=examples)
        def does_not_fail(case: Case[Any]) -> None:
            answer = case.call(headers=documented_api.headers(who))
            answered[answer.status_code] += 1
            said = (case.operation.label, answer.status_code, answer.content[:500])
            assert answer.status_code < 500 or answer.status_code == 503, said
            if answer.status_code >= 400:
                assert answer.headers["content-type"] == ["application/problem+json"], said

        does_not_fail()
    assert answered[401 if who == NOBODY else 403] > 0
