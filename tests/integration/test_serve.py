"""`mcc serve` comes up whole or says why not, and goes down whole."""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

import mms
import scl
from core.error_words import one_line
from service.application.serve import serve
from service.cli.run_service import TROUBLES
from service.client.rest_client import ServiceClient
from service.configuration.settings import Settings
from service.demo import MOTORS
from testing.ports import LOOPBACK, free_port
from testing.service.processes import (
    START_LIMIT_S,
    descendants,
    is_alive,
    running_service,
    serve_in_vain,
    service_environment,
    switched_off_plant,
)
from testing.waiting import eventually

LOST = "3 of 3 relays do not answer"
API_PAGE = Path(__file__).parents[2] / "docs" / "reference" / "api.md"

pytestmark = pytest.mark.timeout(300)
"""Starting and stopping a service may take START_LIMIT_S each."""


def test_every_part_is_documented_and_ready_and_sigterm_ends_every_process(tmp_path: Path) -> None:
    page = API_PAGE.read_text(encoding="utf-8")
    documented = re.findall(r"^\| `(\w+)` \|", page.partition("| Part of `/readyz` |")[2], re.MULTILINE)
    rules = '{"link_down_s": 0.5, "site_lost_s": 1}'
    with running_service(tmp_path, switched_off_plant(tmp_path), MCC_ALARMS=rules) as service:
        parts = httpx.get(f"{service.url}/readyz", trust_env=False, timeout=30).json()["parts"]
        assert parts == dict.fromkeys(set(documented) - {"audit_forwarding"}, "ready"), "no server is set"
        assert eventually(lambda: lost_sites(service.url) == ["FACTORY_A", "FACTORY_B"], 60)
        below = descendants(service.process_id)
        assert len(below) >= 3, "a collector and two workers"
        assert service.stop() == 0
        assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)
    assert "Traceback" not in service.log.read_text()


def test_gateways_to_other_systems_run_beside_the_service_and_end_with_it(tmp_path: Path) -> None:
    tables = {"iec61850": {"port": free_port()}, "modbus": {"port": free_port()}}
    scd = switched_off_plant(tmp_path)
    with running_service(tmp_path, scd, MCC_GATEWAYS=json.dumps(tables)) as service:

        def integrations() -> list[tuple[object, object]]:
            with ServiceClient(service.url) as client:
                return [(one["kind"], one["problem"]) for one in client.items("/integrations")]

        assert eventually(lambda: integrations() == [("iec61850", None), ("modbus", None)], 60)
        with mms.Client.connect(LOOPBACK, tables["iec61850"]["port"]) as client:
            reference = "MCCPUMP_A1/LPHD1.Proxy.stVal"
            assert client.read(reference, mms.FunctionalConstraint.ST) is True
        below = descendants(service.process_id)
        assert service.stop() == 0
        assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)
    assert "Traceback" not in service.log.read_text()


def lost_sites(url: str) -> list[str] | None:
    """The sites of which one alarm says that they are lost; None where anything else calls for somebody."""
    with ServiceClient(url) as client:
        calling = list(client.items("/alarms/open", state="unacknowledged"))
    if any((alarm["kind"], alarm["reason"]) != ("site-lost", LOST) for alarm in calling):
        return None
    return sorted(str(alarm["site"]) for alarm in calling)


def test_ctrl_c_is_an_ordinary_end(tmp_path: Path) -> None:
    with running_service(tmp_path, switched_off_plant(tmp_path)) as service:
        assert service.process is not None
        service.process.send_signal(signal.SIGINT)
        assert service.process.wait(30) == 0


@pytest.mark.campaign
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_to_all_its_processes_during_the_start_logs_no_error(
    tmp_path: Path, number: signal.Signals
) -> None:
    """As systemd sends SIGTERM, and a terminal Ctrl-C: while gateway and workers still load."""
    log = tmp_path / "service.log"
    environment = service_environment(
        tmp_path / "data", {"MCC_SCD": str(switched_off_plant(tmp_path)), "MCC_PORT": "0"}
    )
    with (
        log.open("wb") as output,
        subprocess.Popen(
            [sys.executable, "-m", "service.cli", "serve"],
            env=environment,
            stdout=output,
            stderr=output,
            start_new_session=True,
        ) as service,
    ):
        assert eventually(lambda: '"event": "serving"' in log.read_text(), START_LIMIT_S)
        os.killpg(service.pid, number)
        assert service.wait(30) == 0
    told = log.read_text()
    assert "Traceback" not in told
    assert '"level": "error"' not in told


def test_a_missing_scd_is_one_line(tmp_path: Path) -> None:
    line = serve_in_vain(tmp_path / "data", MCC_SCD=str(tmp_path / "missing.scd"))
    assert "missing.scd" in line
    assert "expected" in line


@pytest.fixture(autouse=True)
def _handler_of_sigterm() -> Iterator[None]:
    """Kept: the service installs its own, also where it runs in this process."""
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


def refusal(data: Path, *, scd: Path = scl.DEMO_PLANT_SCD, motors: Path = MOTORS) -> str:
    """Why the service does not start, in this process; the test above sees how a process says it."""
    with pytest.raises(TROUBLES) as refused:
        serve(Settings(data_directory=data, scd=scd, motors=motors))
    return one_line(str(refused.value))


def test_a_damaged_scd_names_the_line(tmp_path: Path) -> None:
    damaged = tmp_path / "damaged.scd"
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    damaged.write_text(text[: len(text) // 2], encoding="utf-8")
    line = refusal(tmp_path / "data", scd=damaged)
    assert "damaged.scd: line " in line


@pytest.mark.parametrize("surplus", [True, False])
def test_a_motor_known_to_one_file_only_is_named(tmp_path: Path, surplus: bool) -> None:
    text = MOTORS.read_text(encoding="utf-8")
    motors = tmp_path / "motors.toml"
    first = text.index("[[motor]]")
    second = text.index("[[motor]]", first + 1)
    table = text[first:second]
    motors.write_text(
        text + table.replace("PUMP-A1", "PUMP-X9") if surplus else text.replace(table, ""), encoding="utf-8"
    )
    line = refusal(tmp_path / "data", motors=motors)
    assert "motors.toml" in line
    assert ("PUMP-X9" if surplus else "PUMP-A1") in line


def test_a_busy_port_is_named(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as busy:
        port = busy.getsockname()[1]
        line = serve_in_vain(tmp_path / "data", MCC_SCD=str(scl.DEMO_PLANT_SCD), MCC_PORT=str(port))
    assert f"127.0.0.1:{port}: expected a free port" in line


def test_a_data_directory_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    shutil.copy(MOTORS, tmp_path / "file")
    line = refusal(tmp_path / "file" / "data")
    assert str(tmp_path / "file") in line


def test_a_database_that_cannot_be_opened_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "statorwatch.sqlite").mkdir()
    line = refusal(tmp_path / "data")
    assert "statorwatch.sqlite: expected a database that can be read and written" in line
