"""Requests that this service refused, for Prometheus."""

from collections.abc import Iterator, Mapping

from prometheus_client.core import CounterMetricFamily
from prometheus_client.registry import Collector

from service.access.refusals import Refusal


class RefusalMetrics(Collector):
    """Tells what was counted since the service started."""

    def __init__(self, counts: Mapping[Refusal, int]) -> None:
        self._counts = counts

    def collect(self) -> Iterator[CounterMetricFamily]:
        refused = CounterMetricFamily(
            "mcc_refused_requests", "Requests and logins that were refused, by reason", labels=["reason"]
        )
        for refusal, requests in self._counts.items():
            refused.add_metric([refusal], requests)
        yield refused
