"""For whoever keeps the service running: alive, ready, and in figures."""

from collections.abc import Iterator, Mapping
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse, PlainTextResponse
from prometheus_client import CollectorRegistry
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from prometheus_client.registry import Collector
from sqlalchemy.exc import SQLAlchemyError

from service.access.permissions import Permission
from service.api.access.requirements import open_to_all, require
from service.api.condition_metrics import ConditionMetrics
from service.api.context import ApiContext, Context
from service.api.link_metrics import LinkMetrics
from service.api.problems import problem_response, problems
from service.api.schemas import Status
from service.storage.repository import Repository
from service.storage.states import AlarmKind
from service.timing.database_silence import database_trouble

router = APIRouter(tags=["operation"])


@router.get("/healthz", dependencies=[open_to_all()])
async def get_health_of_service() -> Status:
    """Answer, which shows that the service runs."""
    # Without a thread, of which all may be busy, and without the database: it is answered under any load.
    return Status(status="ok")


@router.get(
    "/readyz", response_model=Status, responses={503: problems(503)[503]}, dependencies=[open_to_all()]
)
def get_readiness(context: Context, request: Request) -> Status | JSONResponse:
    """Tell whether all parts of the service work; otherwise answer 503, and say which does not and why."""
    parts = _parts(context)
    failing = {part: problem for part, problem in parts.items() if problem is not None}
    if not failing:
        return Status(status="ready", parts=dict.fromkeys(parts, "ready"))
    return problem_response(
        request.url.path,
        HTTPStatus.SERVICE_UNAVAILABLE,
        "; ".join(f"{part}: {problem}" for part, problem in failing.items()),
        parts={part: problem or "ready" for part, problem in parts.items()},
    )


@router.get("/metrics", response_class=PlainTextResponse, dependencies=[require(Permission.METRICS)])
def get_metrics(context: Context) -> Response:
    """Return the numbers of links, recording requests, recordings, jobs, alarms and motors by state.

    Also the figures of each link and of each motor's condition. Prometheus text format.
    """
    registry = CollectorRegistry()
    registry.register(_StateCollector(context.repository))
    registry.register(ConditionMetrics(context.repository, context.settings.stale_after_days))
    registry.register(LinkMetrics(context.repository))
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)


def _parts(context: ApiContext) -> dict[str, str | None]:
    parts: dict[str, str | None] = {"database": None}
    try:
        context.repository.check()
    except SQLAlchemyError as error:
        parts["database"] = database_trouble(error)
    return parts | {part: problem() for part, problem in context.readiness.items()}


class _StateCollector(Collector):
    """Asks the database when it is asked, so that the figures are those of all processes."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository

    def collect(self) -> Iterator[GaugeMetricFamily]:
        counts = self._repository.counts()
        families: Mapping[str, Mapping[str, int]] = {
            "links": {str(state): count for state, count in counts.links.items()},
            "event_reports": {str(state): count for state, count in counts.recording_requests.items()},
            "recordings": {str(state): count for state, count in counts.recordings.items()},
            "jobs": {str(state): count for state, count in counts.jobs.items()},
        }
        for name, by_state in families.items():
            family = GaugeMetricFamily(
                f"mcc_{name}", f"Number of {name.replace('_', ' ')} by state", labels=["state"]
            )
            for state, count in sorted(by_state.items()):
                family.add_metric([state], count)
            yield family
        alarms = GaugeMetricFamily("mcc_alarms", "Number of standing alarms by kind", labels=["kind"])
        for kind in AlarmKind:
            alarms.add_metric([kind], counts.alarms.get(kind, 0))
        yield alarms
