"""examples/monitoring: a real Prometheus takes its files, scrapes a real service, and its alert fires."""

import json
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml
from grafana_foundation_sdk.cog import plugins
from grafana_foundation_sdk.cog.encoder import JSONEncoder
from grafana_foundation_sdk.models.dashboard import Dashboard

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.not_installed import not_installed
from testing.service.conditions import FAULT, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, fault
from testing.service.prometheus import PrometheusPrograms, programs, serving_prometheus
from testing.waiting import wait_until
from tests.docs.pages import ROOT
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]

FOLDER = ROOT / "examples/monitoring"
DASHBOARD = FOLDER / "grafana-dashboard.json"
METRIC = re.compile(r"\bmcc_\w+")


@pytest.fixture(scope="module")
def prometheus() -> PrometheusPrograms:
    """Where none is installed the test is skipped, and fails where CI=true."""
    found = programs()
    if found is None:
        not_installed("no prometheus and promtool: apt-get install --no-install-recommends prometheus")
    return found


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the example, as a user makes it."""
    copied = tmp_path / "monitoring"
    shutil.copytree(FOLDER, copied)
    (copied / "statorwatch.token").write_text("secret\n")
    return copied


def test_the_files_are_as_prometheus_wants_them(prometheus: PrometheusPrograms, folder: Path) -> None:
    for words in (
        ("check", "config", "prometheus.yml"),
        ("check", "rules", "--lint=all", "--lint-fatal", "statorwatch.rules.yml"),
        ("test", "rules", "statorwatch.tests.yml"),
    ):
        done = subprocess.run([prometheus.promtool, *words], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


def test_every_alert_has_a_test() -> None:
    rules = yaml.safe_load((FOLDER / "statorwatch.rules.yml").read_text())
    alerts = {rule["alert"] for group in rules["groups"] for rule in group["rules"] if "alert" in rule}
    cases = yaml.safe_load((FOLDER / "statorwatch.tests.yml").read_text())["tests"]
    fired = {one["alertname"] for case in cases for one in case["alert_rule_test"] if one["exp_alerts"]}
    assert fired == alerts


def test_the_dashboard_is_one_that_grafana_knows() -> None:
    """Grafana's own library reads it and writes the same: it has no field that Grafana does not know."""
    plugins.register_default_plugins()
    document = json.loads(DASHBOARD.read_text())
    written = json.loads(JSONEncoder(sort_keys=True).encode(Dashboard.from_json(document)))
    assert _without(document, written) == []
    ids = [panel["id"] for panel in document["panels"]]
    assert len(set(ids)) == len(ids)


def _without(document: Any, written: Any, place: str = "") -> list[str]:
    """Where the second document lacks something of the first one."""
    if isinstance(document, dict):
        return [
            lacking
            for key, value in document.items()
            for lacking in (
                _without(value, written[key], f"{place}/{key}") if key in written else [f"{place}/{key}"]
            )
        ]
    if isinstance(document, list) and len(document) == len(written):
        return [
            lacking
            for at, (one, other) in enumerate(zip(document, written, strict=True))
            for lacking in _without(one, other, f"{place}/{at}")
        ]
    return [] if document == written else [place]


def test_rules_and_dashboard_use_metrics_that_there_are() -> None:
    page = set(METRIC.findall((ROOT / "docs/reference/metrics.md").read_text()))
    for name in ("statorwatch.rules.yml", "statorwatch.tests.yml", "grafana-dashboard.json"):
        assert set(METRIC.findall((FOLDER / name).read_text())) <= page, name


def test_a_real_prometheus_scrapes_a_service_and_its_alert_fires(
    prometheus: PrometheusPrograms,
    client: httpx.Client,
    repository: Repository,
    store: RecordingStore,
    folder: Path,
) -> None:
    add_diagnosed(repository, store, fault(), NOW_NS)
    waits = store.store({"E2.CFF": b"samples of a recording that waits for its diagnosis"})
    repository.add_recording(waits, motor="PUMP-A1", now_ns=NOW_NS)
    tell(repository, FAULT)
    made = client.post("/api/v1/account/tokens", json={"label": "prometheus", "scope": ["metrics"]})
    token = made.raise_for_status().json()["token"]
    (folder / "statorwatch.token").write_text(f"{token}\n")
    narrow = {"Authorization": f"Bearer {token}"}
    assert client.get("/api/v1/motors", headers=narrow).status_code == 403, "it is for scrapes alone"
    assert client.get("/metrics", headers={"Authorization": "Bearer another"}).status_code == 401
    config = folder / "prometheus.yml"
    text = config.read_text().replace("127.0.0.1:8710", f"{client.base_url.host}:{client.base_url.port}")
    for name, often in (("scrape", "2s"), ("evaluation", "250ms")):
        text = text.replace(f"{name}_interval: 30s", f"{name}_interval: {often}")
    config.write_text(text)
    with serving_prometheus(prometheus, config, folder) as server:
        wait_until(lambda: [one["health"] for one in server.targets()] == ["up"], "a scrape")

        def firing() -> dict[str, Mapping[str, Any]]:
            return {one["labels"]["alertname"]: one for one in server.alerts() if one["state"] == "firing"}

        wait_until(lambda: "MotorFault" in firing(), "the alert")
        alert = firing()["MotorFault"]
        assert alert["labels"]["motor"] == "PUMP-A1"
        told = "Its fault level is 1.21%. mcc health PUMP-A1 tells what to do."
        assert alert["annotations"]["description"] == told
        (level,) = server.query('mcc_motor_fault_level_ratio{motor="PUMP-A1"}')
        assert level["value"][1] == "0.0121"
        silent = [
            expression
            for expression in expressions()
            if not server.query(expression.replace("$job", "statorwatch").replace("$motor", "PUMP-A1"))
        ]
        assert not silent, "each figure of the dashboard shows something of a motor with a fault"


def expressions() -> list[str]:
    """What the panels of the dashboard ask Prometheus."""
    panels = json.loads(DASHBOARD.read_text())["panels"]
    return [target["expr"] for panel in panels for target in panel.get("targets", [])]
