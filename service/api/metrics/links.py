"""Links and gateways in figures, for Prometheus: one time series a relay and figure."""

from collections.abc import Iterator

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from core.units import NANOSECONDS_PER_SECOND
from service.storage.records import IedEntry
from service.storage.repository import Repository
from service.storage.states import LinkState

PAGE = 1000
LABELS = ["ied"]


class LinkMetrics(Collector):
    """Asks the database when it is asked."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository

    def collect(self) -> Iterator[Metric]:
        up = GaugeMetricFamily("mcc_link_up", "1 where the relay answers", labels=LABELS)
        success = GaugeMetricFamily(
            "mcc_link_last_success_timestamp_seconds",
            "When the relay last answered (UNIX time)",
            labels=LABELS,
        )
        for relay in self._relays():
            up.add_metric([relay.name], relay.link_state is LinkState.UP)
            if relay.last_success_ns is not None:
                success.add_metric([relay.name], relay.last_success_ns / NANOSECONDS_PER_SECOND)
        held = GaugeMetricFamily("mcc_gateway_relays", "Relays held by the gateway", labels=["gateway"])
        for gateway in self._repository.gateways():
            held.add_metric([gateway.id], gateway.relays)
        yield held
        yield up
        yield success
        trip = GaugeMetricFamily(
            "mcc_link_round_trip_seconds", "Duration of its latest answer", labels=LABELS
        )
        counters = {
            name: CounterMetricFamily(f"mcc_link_{name}", help_text, labels=LABELS)
            for name, help_text in (
                ("connections", "Connections made"),
                ("received_bytes", "Bytes of files received"),
                ("reports", "Reports received"),
                ("report_gaps", "How often reports were lost"),
            )
        }
        for figures in self._repository.all_link_figures():
            if figures.round_trip_s is not None:
                trip.add_metric([figures.ied], figures.round_trip_s)
            counters["connections"].add_metric([figures.ied], figures.connections)
            counters["received_bytes"].add_metric([figures.ied], figures.received_bytes)
            counters["reports"].add_metric([figures.ied], figures.reports)
            counters["report_gaps"].add_metric([figures.ied], figures.report_gaps)
        yield trip
        yield from counters.values()

    def _relays(self) -> Iterator[IedEntry]:
        after = None
        while True:
            page = self._repository.relays(limit=PAGE, after=after)
            yield from page.items
            if page.next is None:
                return
            after = page.next
