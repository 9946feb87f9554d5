"""The command ied-sim as a process of its own."""

import json
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import scl
from ied_sim.cli import app
from ied_sim.errors import SimulatorError
from ied_sim.profiles.profile import shipped
from ied_sim.scenario.scenario import healthy_reference
from ied_sim.simulator import Simulator
from mms import Client, FunctionalConstraint, ServerPump
from mms.server.pump import PumpedServer
from scl import Address
from testing.ports import free_port
from testing.relays.simulated import fetch, names, recordings
from testing.waiting import wait_until
from tests.scl.documents import NODE_ZERO, scl_text, write_scl
from tests.scl.vendor_shapes import SHAPES

DEMO_SCENARIO = Path(__file__).parents[2] / "service" / "demo" / "scenario.toml"
RELAYS = ("A1_SEL710", "A2_SEL710", "A3_SEL710", "B1_SEL710", "B2_SEL710", "B3_SEL710")

HEALTHY: dict[str, object] = {
    "running": True,
    "mu_f": 0.0,
    "theta_f": None,
    "joint_ohm": 0.0,
    "broken_bars": 0.0,
    "bars": 28,
    "eccentricity": {"static": 0.0, "dynamic": 0.0},
    "pulsations": [],
    "channels": {},
}


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    """The demo plant's SCD on free ports."""
    path = tmp_path / "plant.scd"
    scl.with_addresses(scl.DEMO_PLANT_SCD, path, {name: Address("127.0.0.1", free_port()) for name in RELAYS})
    return path


def run(*arguments: str | Path) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a call that ends before it serves."""
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    return done.exit_code, done.stdout, done.stderr


def run_process(*arguments: str | Path) -> tuple[int, str, str]:
    """The same of a call that ends when it begins to serve, which blocks signals of its process."""
    command = [sys.executable, "-m", "ied_sim", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stdout, done.stderr


@contextmanager
def serving(*arguments: str | Path) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """The command as a process, with what it printed until it was ready."""
    command = [sys.executable, "-m", "ied_sim", *map(str, arguments)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            lines: list[str] = []
            while "ready" not in lines:
                line = process.stdout.readline()
                assert line, f"ended before it was ready: {process.stderr and process.stderr.read()}"
                lines.append(line.strip())
            yield process, lines
        finally:
            process.kill()


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_serves_until_it_is_told_to_stop(plant: Path, stop: signal.Signals) -> None:
    with serving("--scd", plant, "--scenario", DEMO_SCENARIO) as (process, lines):
        document = scl.read(plant)
        addresses = {name: document.address(name) for name in RELAYS}
        assert lines == [f"{name} {address.host} {address.port}" for name, address in addresses.items()] + [
            "ready"
        ]
        for name, address in addresses.items():
            with Client.connect(address.host, address.port) as client:
                assert f"{name}CON" in client.logical_devices()
        process.send_signal(stop)
        assert process.wait(20) == 0


def test_serves_only_the_relays_asked_for_and_keeps_their_files(plant: Path, tmp_path: Path) -> None:
    with serving("--scd", plant, "--ied", "B1_SEL710", "--files", tmp_path / "files") as (process, lines):
        assert [line.split()[0] for line in lines] == ["B1_SEL710", "ready"]
        process.terminate()
        assert process.wait(20) == 0
    assert (tmp_path / "files" / "B1_SEL710" / "EVENTS").is_dir()


def test_says_when_a_scenario_of_the_past_began(plant: Path) -> None:
    month = ("--scenario", DEMO_SCENARIO.with_name("month.toml"))
    with serving("--scd", plant, "--ied", "B1_SEL710", *month) as (process, lines):
        assert [line.split()[0] for line in lines] == ["B1_SEL710", "began", "ready"]
        began = datetime.fromisoformat(lines[1].split()[1])
        assert datetime.now(UTC) - began == pytest.approx(timedelta(days=30), abs=timedelta(minutes=5))
        process.terminate()
        assert process.wait(20) == 0


def test_tells_the_truth(plant: Path) -> None:
    code, answer, _ = run("--scd", plant, "--scenario", DEMO_SCENARIO, "--truth")
    assert code == 0
    truth = json.loads(answer)
    assert tuple(truth) == RELAYS
    faulted = {"mu_f": 0.05, "theta_f": 1, "coil": 3, "coil_axis_deg": 20.0, "load_level": 0.65}
    assert truth["A2_SEL710"] == {**HEALTHY, **faulted}
    assert truth["A1_SEL710"]["theta_f"] is None


def test_the_truth_without_a_scenario_is_healthy_and_may_be_of_one_relay(plant: Path) -> None:
    code, answer, _ = run("--scd", plant, "--truth", "--ied", "A3_SEL710", "--at", "5")
    assert code == 0
    assert json.loads(answer) == {"A3_SEL710": {**HEALTHY, "load_level": 0.5}}


def test_a_taken_port_is_named_with_its_relay(plant: Path) -> None:
    address = scl.read(plant).address("A3_SEL710")
    with socket.socket() as other:
        other.bind((address.host, address.port))
        other.listen()
        code, _, error = run_process("--scd", plant)
    assert code == 1
    assert f"A3_SEL710: cannot listen on 127.0.0.1 port {address.port}" in error


@pytest.mark.parametrize("arguments", [("--truth",), ()])
def test_an_unknown_relay_is_named(plant: Path, arguments: tuple[str, ...]) -> None:
    code, _, error = run_process("--scd", plant, "--ied", "C9_SEL710", *arguments)
    assert code == 1
    assert "C9_SEL710" in error
    assert "A1_SEL710" in error


def test_a_missing_scd_is_named(tmp_path: Path) -> None:
    code, _, error = run("--scd", tmp_path / "nowhere.scd")
    assert code == 1
    assert "nowhere.scd" in error


def test_a_scenario_for_a_relay_that_is_not_there_is_refused(plant: Path, tmp_path: Path) -> None:
    scenario = tmp_path / "scenario.toml"
    scenario.write_text(
        DEMO_SCENARIO.read_text(encoding="utf-8").replace("A1_SEL710", "A9_SEL710"), encoding="utf-8"
    )
    code, _, error = run("--scd", plant, "--scenario", scenario)
    assert code == 1
    assert "[motor A9_SEL710] ied: expected an IED of" in error


def test_a_directory_that_cannot_be_made_is_named(plant: Path, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file where the directory should be", encoding="utf-8")
    code, _, error = run_process("--scd", plant, "--files", tmp_path / "taken")
    assert code == 1
    assert "taken" in error


def test_meters_are_updated_while_serving(plant: Path, tmp_path: Path) -> None:
    often = replace(healthy_reference("A1_SEL710"), metering_period_s=0.05, metering_refresh_s=0.05)
    scenarios = {"A1_SEL710": often}
    with Simulator(scl.read(plant), scenarios, files=tmp_path, ieds=["A1_SEL710"]) as simulator:
        server = simulator.relays["A1_SEL710"].server
        first = server.read("A1_SEL710MET/METMMXU1.Hz.t")
        wait_until(lambda: server.read("A1_SEL710MET/METMMXU1.Hz.t") != first, "new meter values")


def test_the_pump_is_told_which_relay_a_request_went_to(
    plant: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[object] = []
    expect = ServerPump.expect

    def noting(pump: ServerPump, server: PumpedServer) -> None:
        told.append(server)
        expect(pump, server)

    monkeypatch.setattr(ServerPump, "expect", noting)
    names = ["A1_SEL710", "A2_SEL710"]
    document = scl.read(plant)
    with Simulator(document, {}, files=tmp_path, ieds=names) as simulator:
        address = document.address("A2_SEL710")
        with Client.connect(address.host, address.port) as client:
            before = len(told)
            assert client.logical_nodes("A2_SEL710CON")
            assert len(told) > before
        assert {id(server) for server in told} == {id(simulator.relays["A2_SEL710"].server)}


def test_a_simulator_that_cannot_start_can_still_be_stopped(plant: Path, tmp_path: Path) -> None:
    address = scl.read(plant).address("A1_SEL710")
    simulator = Simulator(scl.read(plant), {}, files=tmp_path, ieds=["A1_SEL710"])
    with socket.socket() as other:
        other.bind((address.host, address.port))
        other.listen()
        with pytest.raises(SimulatorError, match="A1_SEL710"):
            simulator.start()
    simulator.stop()


def test_one_relay_of_a_profile_is_served_without_an_scd(tmp_path: Path) -> None:
    port = str(free_port())
    with serving("--profile", "rdre", "--port", port, "--files", tmp_path) as (process, lines):
        assert lines == [f"SIM_RELAY 127.0.0.1 {port}", "ready"]
        with Client.connect("127.0.0.1", int(port)) as client:
            assert "SIM_RELAYRec_FaultRecorder" in client.logical_devices()
        process.terminate()
        assert process.wait(20) == 0


def test_relays_without_an_address_are_served_at_consecutive_ports(tmp_path: Path) -> None:
    """Two CIDs in one file; the terminal tells what is left out of them."""
    odd = '<LN lnClass="GGIO" inst="2" lnType="gone"/>'
    server = f'<Server><Authentication/><LDevice inst="LD0">{NODE_ZERO}{odd}</LDevice></Server>'
    second = f'<IED name="R2"><AccessPoint name="S1">{server}</AccessPoint></IED>'
    text = scl_text(communication="").replace("</IED>", f"</IED>{second}")
    path = write_scl(tmp_path / "relays.cid", text)
    first = free_port_pair()
    with serving("--scd", path, "--port", str(first)) as (process, lines):
        assert lines == [f"R1 127.0.0.1 {first}", f"R2 127.0.0.1 {first + 1}", "ready"]
        with Client.connect("127.0.0.1", first + 1) as client:
            assert client.logical_devices() == ["R2LD0"]
        process.terminate()
        _, told = process.communicate(timeout=20)
    assert 'relays.cid: line 8: <LN inst="2" lnClass="GGIO" lnType="gone">: its data objects are left' in told


def test_cids_of_several_relays_are_served_together(tmp_path: Path) -> None:
    """One of them has an IED name that another one has."""
    first, second = tmp_path / "feeder.cid", tmp_path / "relay.iid"
    write_scl(first, SHAPES["edition-1.cid"])
    write_scl(second, SHAPES["edition-2.iid"])
    write_scl(tmp_path / "copy.cid", SHAPES["edition-1.cid"])
    port = free_port_pair()
    files = ("--scd", first, "--scd", second, "--scd", tmp_path / "copy.cid")
    with serving(*files, "--port", str(port)) as (process, lines):
        assert lines == [f"FEEDER_1 127.0.0.1 {port}", f"RELAY_2 127.0.0.1 {port + 1}", "ready"]
        process.terminate()
        _, told = process.communicate(timeout=20)
    assert "copy.cid: FEEDER_1 is not served: another file has an IED of this name" in told


def test_of_much_that_is_left_out_the_terminal_tells_some(tmp_path: Path) -> None:
    odd = "".join(f'<LN lnClass="GGIO" inst="{n}" lnType="gone"/>' for n in range(2, 60))
    path = write_scl(tmp_path / "odd.cid", scl_text(nodes=odd))
    code, _, _ = run("--scd", path, "--truth")
    assert code == 0
    told = run_process("--scd", path, "--truth")[2]
    assert told.count("its data objects are left out") == 20
    assert "odd.cid: 38 more are left out: mcc import-scl lists them" in told


def free_port_pair() -> int:
    """A free port with a free one above it."""
    while True:
        port = free_port()
        with socket.socket() as above:
            try:
                above.bind(("127.0.0.1", port + 1))
            except (OSError, OverflowError):
                continue
        return port


def test_a_file_without_addresses_says_how_it_is_served(tmp_path: Path) -> None:
    path = write_scl(tmp_path / "relay.cid", scl_text(communication=""))
    code, _, error = run_process("--scd", path)
    assert code == 1
    assert "R1" in error
    assert "--host and --port give it an address" in error


def test_more_relays_than_ports_are_refused(plant: Path) -> None:
    code, _, error = run("--scd", plant, "--port", "65533")
    assert code == 1
    assert "6 relays from port 65533 on" in error


def test_an_unknown_profile_is_told_with_those_there_are() -> None:
    code, _, error = run("--profile", "siprotec")
    assert code == 1
    assert "expected one of files-none" in error


def test_a_call_names_an_scd_or_a_profile() -> None:
    ended = CliRunner().invoke(app, [])
    assert ended.exit_code == 2
    assert "give --scd or --profile" in " ".join(ended.output.split())


def test_the_profiles_are_listed() -> None:
    listed = CliRunner().invoke(app, ["--profiles"])
    assert listed.exit_code == 0
    assert [line.split()[0] for line in listed.output.splitlines()] == list(shipped())


VENDOR_SCENARIO = """
[[motor]]
ied = "FEEDER_1"
[motor.nameplate]
rated_power_W = 250000
rated_voltage_V = 3300
rated_frequency_Hz = 50
pole_pairs = 2
connection = "star"
[motor.parameters]
stator_resistance_ohm = 0.335
rotor_resistance_ohm = 0.345
stator_leakage_H = 0.00885
rotor_leakage_H = 0.00885
stator_self_inductance_H = 0.385
inertia_kgm2 = 4.6
[motor.load]
level = 0.7
[motor.recorder]
pre_trigger_s = 0.04
post_trigger_s = 0.08
"""


def test_a_maker_s_cid_is_served_with_a_motor_of_a_scenario(tmp_path: Path) -> None:
    """Its remote bit makes a record of the scenario's motor, and its MMXU meters the same currents."""
    cid = write_scl(tmp_path / "feeder.cid", SHAPES["edition-1.cid"])
    scenario = write_scl(tmp_path / "scenario.toml", VENDOR_SCENARIO)
    port = free_port()
    with serving("--scd", cid, "--port", str(port), "--scenario", scenario) as (process, lines):
        assert lines == [f"FEEDER_1 127.0.0.1 {port}", "ready"]
        with Client.connect("127.0.0.1", port) as client:
            client.operate("FEEDER_1CON/RBGGIO1.SPCSO01", value=True)
            wait_until(lambda: names(client, "EVENTS"), "a record")
            (record,) = recordings(fetch(client, "EVENTS", tmp_path / "fetched"))
            metered = client.read("FEEDER_1MET/METMMXU1.A.phsA.cVal.mag.f", FunctionalConstraint.MX)
        process.terminate()
        assert process.wait(20) == 0
    currents = np.sqrt(np.mean(record.samples[:3] ** 2, axis=1))
    assert currents == pytest.approx([metered] * 3, rel=0.05)
    assert 30 < currents[0] < 60
    line_voltage = np.sqrt(3 * np.mean(record.samples[3] ** 2))
    assert line_voltage == pytest.approx(3300, rel=0.02)
