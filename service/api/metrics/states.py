"""How much there is of everything, by state, for Prometheus."""

from collections.abc import Iterator, Mapping

from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector

from service.storage.repository import Repository
from service.storage.states import AlarmKind, AlarmPriority, AlarmState


class StateMetrics(Collector):
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
        opened = GaugeMetricFamily(
            "mcc_alarms_open",
            "Number of alarms that are not over, by state and priority",
            labels=["state", "priority"],
        )
        open_alarms = self._repository.open_alarm_counts()
        for state in AlarmState:
            for priority in AlarmPriority:
                if state is not AlarmState.NORMAL:
                    opened.add_metric([state, priority], open_alarms.get((state, priority), 0))
        yield opened
        yield self._messages()

    def _messages(self) -> GaugeMetricFamily:
        messages = GaugeMetricFamily(
            "mcc_notifications",
            "Number of messages that wait, are being sent, or were given up, by channel",
            labels=["channel", "state"],
        )
        for (channel, state), number in sorted(self._repository.waiting_notifications().items()):
            messages.add_metric([channel, state], number)
        return messages
