import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
from prometheus_client import Metric
from prometheus_client.parser import text_string_to_metric_families

from core.condition.forecast.outcome import Forecast
from core.units import NANOSECONDS_PER_SECOND
from service.plant import PlantMotor
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import AlarmKind
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, fault, motor, two_motor_plant, undiagnosable

PAGE = Path(__file__).parents[4] / "docs/reference/metrics.md"
PREFIX = "mcc_motor_"
HOUR_NS = 3600 * NANOSECONDS_PER_SECOND


def scraped(client: httpx.Client) -> dict[str, Metric]:
    """All metrics, read by Prometheus' own parser for Python."""
    answer = client.get("/metrics")
    assert answer.status_code == 200
    return {family.name: family for family in text_string_to_metric_families(answer.text)}


def of_motor(families: dict[str, Metric], name: str) -> dict[tuple[str, ...], float]:
    """The figures of a motor: by the metric's name and its further labels."""
    return {
        (
            sample.name.removeprefix(PREFIX),
            *(v for k, v in sample.labels.items() if k != "motor"),
        ): sample.value
        for family in families.values()
        for sample in family.samples
        if sample.labels.get("motor") == name
    }


def test_a_motor_has_all_its_figures(client: httpx.Client, repository: Repository) -> None:
    hour_ago_ns = time.time_ns() - HOUR_NS
    tell(repository, replace(FAULT, as_of_ns=hour_ago_ns))
    found = of_motor(scraped(client), "PUMP-A1")
    age_s = found.pop(("condition_age_seconds",))
    assert 3600 <= age_s < 3600 + 600
    assert found[("state", "fault")] == 1.0
    assert found[("state", "healthy")] == 0.0
    assert found[("fault_level_ratio",)] == 0.0121
    assert (found[("fault_level_bound_ratio", "low")], found[("fault_level_bound_ratio", "high")]) == (
        0.009,
        0.0225,
    )
    assert found[("fault_level_change_ratio",)] == 0.012
    assert found[("fault_level_detectable_change_ratio",)] == 0.0045
    assert found[("fault_level_growth_ratio_per_day",)] == 0.0004
    assert found[("condition_timestamp_seconds",)] == pytest.approx(hour_ago_ns / NANOSECONDS_PER_SECOND)
    assert found[("condition_stale",)] == 0.0


def test_a_motor_without_records_has_no_figure_that_is_not_known(
    client: httpx.Client, repository: Repository
) -> None:
    tell(repository, replace(HEALTHY, forecast=Forecast(0.005)))
    families = scraped(client)
    assert ("fault_level_growth_ratio_per_day",) not in of_motor(families, "PUMP-A1")
    assert {name for name, *_ in of_motor(families, "FAN-A2")} == {"state", "kind", "condition_stale"}


def test_the_latest_valid_recording_tells_load_and_detection_limit(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    earlier, valid = replace(fault(), load_level=0.3), replace(fault(), load_level=0.9)
    for hours, diagnosis in ((2, valid), (1, earlier), (3, undiagnosable())):
        add_diagnosed(repository, store, diagnosis, NOW_NS + hours * HOUR_NS)
    found = of_motor(scraped(client), "PUMP-A1")
    assert found[("load_ratio",)] == 0.9
    assert found[("detection_limit_ratio",)] == 0.021
    assert found[("recording_timestamp_seconds",)] == (NOW_NS + 2 * HOUR_NS) / NANOSECONDS_PER_SECOND


def test_open_alarms_are_counted_by_state_and_priority(client: httpx.Client, repository: Repository) -> None:
    raised = repository.raise_alarm("A1_SEL710", AlarmKind.QUARANTINED, "", "crashed", now_ns=NOW_NS)
    repository.raise_alarm("A2_SEL710", AlarmKind.FILE_REFUSED, "x", "odd", now_ns=NOW_NS)

    def counted() -> dict[tuple[str, str], float]:
        samples = scraped(client)["mcc_alarms_open"].samples
        return {(one.labels["state"], one.labels["priority"]): one.value for one in samples}

    assert len(counted()) == 6 * 4, "those that there are none of are 0"
    assert sum(counted().values()) == 2
    assert counted()["unacknowledged", raised.priority] >= 1
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, relays=plant.relays[:1], motors=plant.motors[:1]))
    assert sum(counted().values()) == 1, "a relay that left the plant calls nobody"


def test_names_of_any_kind_are_read_back_as_they_are(client: httpx.Client, repository: Repository) -> None:
    name = 'P "1"\\n\n{x="y"} 1 # Pümpe €'
    plant = two_motor_plant()
    odd = PlantMotor(motor(name), "Pump", "FACTORY_A", "A1_SEL710")
    repository.sync_plant(replace(plant, motors=(odd,)))
    assert of_motor(scraped(client), name)[("state", "unknown")] == 1.0


def test_every_figure_is_on_the_page(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    add_diagnosed(repository, store, fault(), NOW_NS)
    tell(repository, FAULT)
    rows = dict(documented())
    names = set()
    for family in scraped(client).values():
        name = family.name + ("_total" if family.type == "counter" else "")
        names.add(name)
        for sample in family.samples:
            assert set(sample.labels) - {"motor"} <= rows[name], name
    later = {"mcc_link_last_success_timestamp_seconds", "mcc_link_round_trip_seconds"}
    assert set(rows) == names | later | {"mcc_gateway_relays"}


def documented() -> Iterator[tuple[str, set[str]]]:
    """The metrics of the page, with their labels."""
    for line in PAGE.read_text().splitlines():
        if line.startswith("| `mcc_"):
            name, label = (cell.strip(" `") for cell in line.split("|")[1:3])
            yield name, {one.strip(" `") for one in label.split(",")}
