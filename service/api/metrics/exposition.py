"""All figures of the service in Prometheus' text format."""

from collections.abc import Mapping

from prometheus_client import CollectorRegistry
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest

from service.access.refusals import Refusal
from service.api.metrics.links import LinkMetrics
from service.api.metrics.motors import MotorMetrics
from service.api.metrics.refusals import RefusalMetrics
from service.api.metrics.states import StateMetrics
from service.storage.repository import Repository

MEDIA_TYPE = CONTENT_TYPE_LATEST


def exposition(
    repository: Repository, stale_after_days: float | None, refused: Mapping[Refusal, int]
) -> bytes:
    """Return what a scrape gets. stale_after_days: that of the settings. refused: since the start."""
    registry = CollectorRegistry(auto_describe=False)
    for collector in (
        StateMetrics(repository),
        MotorMetrics(repository, stale_after_days),
        LinkMetrics(repository),
        RefusalMetrics(refused),
    ):
        registry.register(collector)
    return generate_latest(registry)
