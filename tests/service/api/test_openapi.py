"""The API is what its OpenAPI document says: requests made from the document, answers checked against it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from schemathesis import BaseSchema, Case, GenerationMode
from schemathesis.core.result import Ok
from schemathesis.specs.openapi.checks import positive_data_acceptance

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import Sample
from service.storage.states import AlarmKind, LinkState
from testing.service.conditions import FAULT, tell
from testing.service.database import make_database
from testing.service.job_runner import RUNNER, register_runner
from testing.service.observations import OBSERVATION
from testing.service.plants import NOW_NS, fault, two_motor_plant
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import serving

NO_WRONG_REQUESTS = {
    "GET /healthz",
    "GET /readyz",
    "GET /metrics",
    "GET /api/v1/audit/head",
    "GET /api/v1/gateways",
    "GET /api/v1/ieds/{name}",
    "GET /api/v1/motors/{name}",
    "GET /api/v1/motors/{name}/health",
    "GET /api/v1/notification-channels",
    "POST /api/v1/notification-channels/{name}/tests",
}
"""Routes that take nothing but a name: any text is one."""


@pytest.fixture(scope="module")
def documented_api(tmp_path_factory: pytest.TempPathFactory) -> Iterator[BaseSchema]:
    """A running API with something in every table."""
    data: Path = tmp_path_factory.mktemp("api")
    engine = connect(make_database(data))
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    store = RecordingStore(data / "recordings")
    register_runner(repository)
    report = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    stored = store.store({"EVENT.CFG": CFG, "EVENT.DAT": DAT})
    repository.add_recording(stored, motor="PUMP-A1", recording_request_id=report.id, now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id,
        fault(),
        recorded_ns=NOW_NS,
        now_ns=NOW_NS,
        runner=RUNNER,
        observation=OBSERVATION,
    )
    repository.set_link_state("A1_SEL710", LinkState.DOWN, "refused", now_ns=NOW_NS)
    repository.register_gateway("here/0", host="here", process_id=1, now_ns=NOW_NS)
    repository.share_relays("here/0", ["A1_SEL710"], most=1, problem=None)
    repository.add_samples([Sample("PUMP-A1", NOW_NS, {"ia_A": 1.0})])
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "X.CFG", "outside", now_ns=NOW_NS)
    tell(repository, FAULT)
    context = ApiContext(Settings(data_directory=data), repository, store)
    with serving(create_app(context)) as client:
        yield schemathesis.openapi.from_url(f"{client.base_url}/api/v1/openapi.json")
    engine.dispose()


@pytest.mark.parametrize("mode", [GenerationMode.POSITIVE, GenerationMode.NEGATIVE])
def test_answers_are_as_documented(documented_api: BaseSchema, mode: GenerationMode) -> None:
    for result in documented_api.get_all_operations():
        assert isinstance(result, Ok), result
        operation = result.ok()
        if mode is GenerationMode.NEGATIVE and operation.label in NO_WRONG_REQUESTS:
            continue

        @given(case=operation.as_strategy(generation_mode=mode))
        @settings(max_examples=12, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
        def answers_as_documented(case: Case[Any]) -> None:
            # A cursor or a file name that fits its schema need not be one of ours: 422 is an answer too.
            case.call_and_validate(excluded_checks=[positive_data_acceptance])

        answers_as_documented()
