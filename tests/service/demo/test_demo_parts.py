"""The demo's parts: ports, programs, results."""

import io
import json
import os
import signal
import socket
import sys
from pathlib import Path

import pytest
from rich.console import Console

import scl
from service.cli.output import as_json, results
from service.demo import MOTORS, SCENARIO
from service.demo.addresses import addressed_scd, free_port, free_ports, is_free
from service.demo.interruption import SIGNALS, interruptible
from service.demo.processes import Program, ProgramError
from service.demo.results import DemoDiagnosis, DemoMotor, document, slowest, table
from service.demo.truth import Truth, TruthError, ask_simulator
from service.plant.files import plant_of_files
from testing.waiting import eventually

DIAGNOSIS = {
    "verdict": "fault", "mu_f": 0.05, "mu_f_ci95": [0.041, 0.059], "detection_limit": 0.021, "phase": "b",
    "load_level": 0.65,
}  # fmt: skip


def test_the_demo_plants_files_belong_together() -> None:
    plant = plant_of_files(scl.DEMO_PLANT_SCD, MOTORS)
    truths = ask_simulator(scl.DEMO_PLANT_SCD, SCENARIO)
    assert {motor.relay for motor in plant.motors} == set(truths)


def test_a_simulator_that_fails_says_why(tmp_path: Path) -> None:
    with pytest.raises(TruthError, match="missing"):
        ask_simulator(scl.DEMO_PLANT_SCD, tmp_path / "missing.toml")


def test_ports_in_use_are_not_fought_for(tmp_path: Path) -> None:
    (port,) = free_ports(1)
    plant = tmp_path / "plant.scd"
    names = [ied.name for ied in scl.read(scl.DEMO_PLANT_SCD).ieds]
    ports = [port, *free_ports(len(names) - 1)]
    addresses = {name: scl.Address("127.0.0.1", each) for name, each in zip(names, ports, strict=True)}
    scl.with_addresses(scl.DEMO_PLANT_SCD, plant, addresses)
    copies = tmp_path / "copies"
    copies.mkdir()
    with socket.create_server(("127.0.0.1", port)):
        assert not is_free(port)
        assert free_port(port) != port
        copy = addressed_scd(plant, copies)
    assert copy.parent == copies
    document_of_copy = scl.read(copy)
    assert port not in {document_of_copy.address(name).port for name in names}


def test_free_ports_are_kept() -> None:
    (port,) = free_ports(1)
    assert free_port(port) == port


def test_a_program_that_ends_leaves_its_last_words(tmp_path: Path) -> None:
    script = "import sys; print('no luck today'); sys.exit(3)"
    with Program("helper", [sys.executable, "-c", script], tmp_path / "log") as program:

        def ended() -> bool:
            try:
                program.check()
            except ProgramError:
                return True
            return False

        assert eventually(ended)
        with pytest.raises(ProgramError, match=r"exit code 3.*no luck today"):
            program.check()


def test_a_program_that_does_not_go_is_killed(tmp_path: Path) -> None:
    stubborn = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN)"
    script = f"{stubborn}; print('deaf', flush=True); time.sleep(60)"
    log = tmp_path / "log"
    with Program("helper", [sys.executable, "-c", script], log, stop_timeout_s=0.2) as program:
        assert eventually(lambda: log.stat().st_size > 0)
    assert not Path(f"/proc/{program.process_id}").exists()


def test_results_stand_beside_the_truth() -> None:
    motors = [
        DemoMotor("FAN-A2", "FACTORY_A", Truth(mu_f=0.05, theta_f=1, load_level=0.65)),
        DemoMotor("PUMP-A1", "FACTORY_A", Truth(mu_f=0.0, theta_f=None, load_level=0.8)),
    ]
    motors[0].diagnoses.append(DemoDiagnosis(DIAGNOSIS, 1.5))
    motors[1].diagnoses.append(DemoDiagnosis(None, None, "A1_SEL710 does not answer"))
    written = json.loads(as_json(document(motors, 12.3456)))
    assert written["seconds"] == 12.346
    first, second = written["motors"]
    assert first["truth"] == {"mu_f": 0.05, "theta_f": 1, "load_level": 0.65}
    assert first["diagnoses"] == [{**DIAGNOSIS, "trigger_to_diagnosis_seconds": 1.5}]
    assert second["diagnoses"] == [{"error": {"message": "A1_SEL710 does not answer"}}]
    assert slowest(motors) == 1.5
    assert slowest(motors[1:]) is None


def test_no_figure_is_cut_off_where_there_is_no_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    motor = DemoMotor("M" * 100, "FACTORY_A", Truth(mu_f=0.05, theta_f=1, load_level=0.65))
    motor.diagnoses.append(DemoDiagnosis(DIAGNOSIS, 1.5))
    results().print(table([motor]))
    out = capsys.readouterr().out
    (row,) = [line for line in out.splitlines() if "M" in line]
    assert row.split()[0] == "M" * 100
    assert "scatter" not in out
    assert "interval: from all causes; see docs/explanation/diagnosis.md" in out
    assert row.split()[-7:] == ["fault", "b", "5.00", "4.10..5.90", "2.10", "0.650", "1.50"]


def test_names_of_motors_stay_whole_at_80_columns() -> None:
    motor = DemoMotor("COMPRESSOR-B2", "FACTORY_B", Truth(mu_f=0.1, theta_f=1, load_level=0.75))
    motor.diagnoses.append(DemoDiagnosis({**DIAGNOSIS, "mu_f_ci95": [0.0821, 0.1112]}, 12.34))
    terminal = Console(file=io.StringIO(), width=80)
    with terminal.capture() as shown:
        terminal.print(table([motor]))
    assert "COMPRESSOR-B2" in shown.get().split()


def test_figures_stay_whole_on_a_narrow_terminal() -> None:
    motor = DemoMotor("COMPRESSOR-B2", "FACTORY_B", Truth(mu_f=0.05, theta_f=1, load_level=0.65))
    motor.diagnoses.append(DemoDiagnosis(DIAGNOSIS, 1.5))
    terminal = Console(file=io.StringIO(), width=60)
    with terminal.capture() as shown:
        terminal.print(table([motor]))
    out = shown.get()
    assert {"5.00", "4.10..5.90"} <= set(out.split())
    left_out = " ".join(out.partition("(no room for: ")[2].split())
    for heading, figure in (("limit %", "2.10"), ("load", "0.650"), ("diagnosis s", "1.50")):
        assert (figure in out.split()) != (heading in left_out)


def test_an_interrupt_waits_for_the_next_pause() -> None:
    before = signal.getsignal(signal.SIGTERM)
    with interruptible() as interruption:
        interruption.pause(0.0)
        for number in SIGNALS:
            os.kill(os.getpid(), number)
        with pytest.raises(KeyboardInterrupt):
            interruption.pause(60.0)
    assert signal.getsignal(signal.SIGTERM) is before
