"""What goes wrong in a plant gives one clear error, and touches nothing else."""

import io
import json
import shutil
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import httpx
import pytest

from core.recordings import Quantity, comtrade, read
from mms import Client
from service.cli import main
from service.client.credentials import headers_for
from service.client.rest_client import ServiceClient
from testing.service.processes import (
    Service,
    SimulatedPlant,
    all_recordings,
    descendants,
    link_states,
    running_service,
    serve_in_vain,
    simulated_plant,
)
from testing.waiting import eventually
from tests.integration.listeners import listening_addresses

pytestmark = pytest.mark.timeout(300)
"""The bench starts in the first test; later ones wait for time limits of relays that are down."""

RELAY, MOTOR = "A1_SEL710", "PUMP-A1"
TRIGGER = f"{RELAY}CON/RBGGIO1.SPCSO01"


@dataclass(frozen=True)
class Bench:
    """One relay of six is switched on; the service watches all six."""

    plant: SimulatedPlant
    service: Service
    good: Path

    def recording(self, name: str) -> Mapping[str, object] | None:
        with ServiceClient(self.service.url) as client:
            return next((row for row in all_recordings(client) if row["name"] == name), None)

    def reason_for_rejecting(self, name: str) -> str:
        """Waits until a record of the relay is rejected."""

        def rejected() -> bool:
            row = self.recording(name)
            return row is not None and row["state"] in ("rejected", "failed", "diagnosed")

        assert eventually(rejected, 30), self.service.log.read_text()
        row = self.recording(name)
        assert row is not None
        assert row["state"] == "rejected", row
        return str(row["reason"])

    def rejected_files(self, name: str) -> Mapping[str, bytes]:
        """What the service keeps of a rejected record, by file name."""
        row = self.recording(name)
        assert row is not None
        answer = httpx.get(
            f"{self.service.url}/api/v1/recordings/{row['id']}/file",
            headers=headers_for(self.service.url),
            trust_env=False,
            timeout=30,
        )
        answer.raise_for_status()
        with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
            return {file: archive.read(file) for file in archive.namelist()}

    def copy_of_good(
        self, name: str, *, configuration: bytes | None = None, data: bytes | None = None
    ) -> None:
        """Another record in the relay's directory, like the good one but for what is given."""
        events = self.plant.events(RELAY)
        (events / f"{name}.DAT").write_bytes(data or self.good.with_suffix(".DAT").read_bytes())
        (events / f"{name}.CFG").write_bytes(configuration or self.good.read_bytes())


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    directory = tmp_path_factory.mktemp("bench")
    with simulated_plant(directory, [RELAY]) as plant:
        address = plant.address(RELAY)
        with Client.connect(address.host, address.port) as client:
            client.operate(TRIGGER, True)  # noqa: FBT003 - the value of a control
            client.operate(TRIGGER, False)  # noqa: FBT003
        assert eventually(lambda: len(plant.records()) == 1, 20)
        (record,) = plant.events(RELAY).glob("*.CFG")
        for path in plant.events(RELAY).glob(f"{record.stem}.*"):
            shutil.copy(path, directory)
        settings = {"MCC_POLL_PERIOD_S": "1", "MCC_RECORD_TIMEOUT_S": "4", "MCC_CONNECT_TIMEOUT_S": "1"}
        with running_service(directory, plant.scd, **settings) as service:
            bench = Bench(plant, service, directory / record.name)
            yield bench
            row = bench.recording(record.stem)
            assert row is not None
            assert row["state"] == "diagnosed", "the good record beside all the bad ones"


def test_a_truncated_data_file_is_rejected(bench: Bench) -> None:
    data = bench.good.with_suffix(".DAT").read_bytes()
    bench.copy_of_good("HR_20001", data=data[: len(data) // 2])
    reason = bench.reason_for_rejecting("HR_20001")
    assert "HR_20001.DAT" in reason
    assert "expected" in reason
    assert bench.rejected_files("HR_20001") == {
        "HR_20001.CFG": bench.good.read_bytes(),
        "HR_20001.DAT": data[: len(data) // 2],
    }


def test_a_configuration_with_a_wrong_count_is_rejected(bench: Bench) -> None:
    lines = bench.good.read_bytes().split(b"\r\n")
    total, analog, digital = lines[1].split(b",")
    lines[1] = b",".join((b"%d" % (int(total) + 1), analog, digital))
    bench.copy_of_good("HR_20002", configuration=b"\r\n".join(lines))
    reason = bench.reason_for_rejecting("HR_20002")
    assert "HR_20002.CFG" in reason
    assert "expected" in reason


def test_a_record_without_voltages_is_rejected(bench: Bench, tmp_path: Path) -> None:
    recording = read(bench.good)
    currents = [i for i, c in enumerate(recording.channels) if c.quantity is Quantity.CURRENT]
    without = replace(
        recording,
        samples=recording.samples[currents],
        channels=tuple(recording.channels[i] for i in currents),
    )
    comtrade.write(tmp_path / "HR_20003", without)
    data = (tmp_path / "HR_20003.DAT").read_bytes()
    bench.copy_of_good("HR_20003", configuration=(tmp_path / "HR_20003.CFG").read_bytes(), data=data)
    reason = bench.reason_for_rejecting("HR_20003")
    assert "voltages" in reason
    assert "HR_20003" in reason


def test_a_configuration_alone_is_rejected(bench: Bench) -> None:
    (bench.plant.events(RELAY) / "HR_20004.CFG").write_bytes(bench.good.read_bytes())
    assert bench.reason_for_rejecting("HR_20004") == "HR_20004: expected a .DAT file in EVENTS, found none"


def test_a_relay_that_is_down_fails_its_recording_request_alone(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    url = bench.service.url
    assert main(["trigger", "FAN-A2", "--url", url, "--wait", "40", "--json"]) == 1
    output = capsys.readouterr()
    error = json.loads(output.out)["error"]
    address = bench.plant.address("A2_SEL710")
    assert "A2_SEL710 does not answer" in error["message"]
    assert f"{address.host}:{address.port}" in error["message"]
    assert "A2_SEL710 does not answer" in output.err
    with ServiceClient(url) as client:
        states = link_states(client)
        assert client.is_ready()
    assert states.pop(RELAY) == "up"
    assert set(states.values()) == {"down"}


def test_the_other_motor_is_still_diagnosed(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    url = bench.service.url
    assert main(["trigger", MOTOR, "--url", url, "--wait", "40", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["state"] == "diagnosed"
    assert main(["health", MOTOR, "--url", url, "--json"]) == 0
    health = json.loads(capsys.readouterr().out)
    assert (health["verdict"], health["link_state"]) == ("healthy", "up")
    assert main(["health", MOTOR, "--url", url]) == 0
    shown = capsys.readouterr().out
    assert "healthy" in shown
    assert " UTC" in shown
    assert main(["trigger", MOTOR, "--url", url, "--wait", "40"]) == 0
    assert capsys.readouterr().out.startswith(f"{MOTOR}: healthy, ")


def test_a_motor_without_recording_says_so(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    url = bench.service.url
    with ServiceClient(url) as client:
        assert eventually(lambda: link_states(client)["B1_SEL710"] == "down", 20)
    assert main(["health", "CONVEYOR-B1", "--url", url]) == 0
    shown = capsys.readouterr().out
    assert "no recording yet" in shown
    assert "down: " in shown
    assert main(["trigger", "CONVEYOR-B1", "--url", url]) == 0
    assert "CONVEYOR-B1: the link to B1_SEL710 is down: " in capsys.readouterr().err


def test_motors_are_listed(
    bench: Bench, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "160")  # a narrow table leaves out the links that are up
    assert main(["motors", "--url", bench.service.url, "--json"]) == 0
    motors = json.loads(capsys.readouterr().out)["motors"]
    assert len(motors) == 6
    assert {motor["health"]["motor"] for motor in motors} == {motor["name"] for motor in motors}
    assert main(["motors", "--url", bench.service.url]) == 0
    rows = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line.split()}
    assert rows[MOTOR].split()[-1] == "up"
    assert rows["PUMP-B3"].split()[1] == "unknown"


@pytest.mark.parametrize("command", ["trigger", "health"])
def test_an_unknown_motor_is_one_line(bench: Bench, command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "NO-SUCH/MOTOR", "--url", bench.service.url, "--json"]) == 1
    output = capsys.readouterr()
    assert output.err.count("\n") == 1
    assert json.loads(output.out)["error"]["message"]
    assert main([command, "NOBODY", "--url", bench.service.url]) == 1
    assert "NOBODY" in capsys.readouterr().err


def test_nothing_listens_beyond_loopback(bench: Bench) -> None:
    processes = [
        bench.service.process_id,
        *descendants(bench.service.process_id),
        bench.plant.process.pid,
    ]
    addresses = listening_addresses(processes)
    assert len(addresses) >= 2, "the API and a relay"
    assert all(address.is_loopback for address in addresses)


def test_a_second_service_on_the_same_data_is_refused(bench: Bench) -> None:
    ended = serve_in_vain(bench.service.data, MCC_SCD=str(bench.plant.scd))
    assert "another service works on this data directory" in ended
    assert str(bench.service.process_id) in ended
