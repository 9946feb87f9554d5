"""The service keeps its gateways running, and knows what they say of themselves."""

import os
import signal
import sys
from pathlib import Path

import pytest

from service.configuration.gateways.modbus import ModbusSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.supervision import STARTING, PlantGateways, missing_library
from testing.waiting import eventually

SCRIPT = """
import sys
sys.stdin.readline()
print('{"problem": "no broker at 127.0.0.1:1883"}', flush=True)
sys.stdin.read()
"""


class TwoKinds(GatewaysSettings):
    first: bool | None = True
    second: bool | None = None


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(data_directory=tmp_path).model_copy(update={"gateways": TwoKinds()})


def test_a_gateway_that_is_killed_is_back_and_says_again_what_does_not_work(settings: Settings) -> None:
    gateways = PlantGateways(settings, (sys.executable, "-c", SCRIPT))
    (before,) = gateways.status()
    assert (before.kind, before.process_id) == ("first", None)
    gateways.start()
    try:
        assert eventually(lambda: gateways.status()[0].problem == "no broker at 127.0.0.1:1883")
        assert gateways.problem() is None
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        assert eventually(lambda: gateways.status()[0].process_id not in (None, first))
        assert eventually(lambda: gateways.status()[0].problem == "no broker at 127.0.0.1:1883")
        assert gateways.status()[0].restarts == 1
    finally:
        gateways.stop()
    assert gateways.problem() == "the gateway first is not running"


def test_a_library_that_is_not_installed_is_named_with_its_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen = Settings(data_directory=tmp_path, gateways=GatewaysSettings(modbus=ModbusSettings()))
    assert missing_library(chosen) is None
    monkeypatch.setattr("service.gateways.supervision.find_spec", lambda _name: None)
    assert missing_library(chosen) == (
        'gateways.modbus: expected the library pymodbus, found none: pip install "statorwatch[modbus]"'
    )
    assert missing_library(Settings(data_directory=tmp_path)) is None


def test_files_of_gateways_lie_beside_the_settings(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    table = '{ certificate = "mcc.pem", key = "mcc.key", pinned = ["hmi.pem"] }'
    config.write_text(f'[gateways.iec61850]\ntls = {table}\n[gateways.opcua]\ntrusted = "clients"\n')
    gateways = Settings.load(config).gateways
    assert gateways.iec61850 is not None
    assert gateways.iec61850.tls is not None
    assert gateways.iec61850.tls.pinned == (tmp_path / "hmi.pem",)
    assert gateways.opcua is not None
    assert gateways.opcua.trusted == tmp_path / "clients"


def test_a_gateway_that_has_said_nothing_starts(settings: Settings) -> None:
    gateways = PlantGateways(settings, (sys.executable, "-c", "import sys; sys.stdin.read()"))
    gateways.start()
    try:
        assert eventually(lambda: gateways.status()[0].process_id is not None)
        assert gateways.status()[0].problem == STARTING
    finally:
        gateways.stop()
