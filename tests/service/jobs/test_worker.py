"""The task of the worker processes, with real files and the real diagnosis."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.diagnosis.verdict import Verdict
from core.machines.parameters import ChannelNames
from core.recordings import Channel, Quantity, Recording
from core.recordings.comtrade.writer import write
from core.starts.measuring import measure_start
from core.table_layout import TableScaling
from core.time_stamps import nanoseconds
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.task import Diagnosed, DiagnosisTask, Rejected
from service.jobs.worker import diagnose_recording, prepare_worker
from service.recording_store.recording import LocalFile
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.timing.backoff import Backoff
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording as waveforms
from testing.machines.phase_circuits import running
from testing.machines.starts import StartRecord
from testing.service.plants import NOW_NS, motor
from testing.waiting import wait_until

TRIGGER_INDEX = 400


def recording(*, voltages: bool = True) -> Recording:
    """0.5 s at 4 kHz of a balanced 380 V, 50 Hz supply and a balanced load that is no motor in particular."""
    angle = 2 * np.pi * (50 * np.arange(2000) / 4000 - np.array([[0], [1], [2]]) / 3)
    currents = [Channel(f"I{p.upper()}", Quantity.CURRENT, p, "A", 20.0) for p in "abc"]
    phase_voltages = [Channel(f"V{p.upper()}", Quantity.PHASE_VOLTAGE, p, "V", 800.0) for p in "abc"]
    samples = np.vstack([2.0 * np.sin(angle - 0.6), 310.0 * np.sin(angle)])
    return Recording(
        samples=samples if voltages else samples[:3],
        sample_rate_hz=4000.0,
        start_time_ns=NOW_NS,
        channels=tuple(currents + phase_voltages if voltages else currents),
        trigger_index=TRIGGER_INDEX,
        nominal_frequency_hz=50.0,
        station="FACTORY A",
        device="A1_SEL710",
    )


def task(entry: Path, method: str = "hcpa") -> DiagnosisTask:
    return DiagnosisTask(LocalFile(entry), motor("PUMP-A1"), method, "split-winding")


def faulty(folder: Path, **changes: str) -> Path:
    """A record of no revision year, as some relays write all of theirs."""
    entry = write(folder / "EVENT", recording(), revision=1999, data_format="BINARY")
    text = entry.read_text()
    for old, new in {",1999": ",0", **changes}.items():
        assert old in text
        text = text.replace(old, new)
    entry.write_text(text, newline="")
    return entry


def test_a_relay_may_be_read_leniently_and_each_repair_is_kept(tmp_path: Path) -> None:
    asked = task(faulty(tmp_path))
    refused = diagnose_recording(asked)
    assert isinstance(refused, Rejected)
    assert "found '0'" in refused.reason
    outcome = diagnose_recording(replace(asked, motor=replace(asked.motor, reads_leniently=True)))
    assert isinstance(outcome, Diagnosed)
    assert outcome.recorded_ns == NOW_NS + TRIGGER_INDEX * 250_000
    repairs = [one for one in outcome.findings.diagnosis.quality if one.message.startswith("repaired: ")]
    assert [(one.name, one.passed) for one in repairs] == [("file", True)]
    assert "the edition is told by the layout" in repairs[0].message


def test_a_record_of_unknown_time_is_rejected_however_it_is_read(tmp_path: Path) -> None:
    entry = faulty(tmp_path)
    lines = entry.read_text().split("\n")
    entry.write_text("\n".join("never" if "/" in line else line for line in lines), newline="")
    asked = task(entry)
    outcome = diagnose_recording(replace(asked, motor=replace(asked.motor, reads_leniently=True)))
    assert isinstance(outcome, Rejected)
    assert "expected a date and time in the file" in outcome.reason


def test_a_record_is_diagnosed_as_of_its_trigger(tmp_path: Path) -> None:
    outcome = diagnose_recording(task(write(tmp_path / "EVENT", recording())))
    assert isinstance(outcome, Diagnosed)
    assert outcome.recorded_ns == NOW_NS + TRIGGER_INDEX * 250_000
    assert (outcome.findings.diagnosis.method, outcome.findings.diagnosis.model) == ("hcpa", "split-winding")


def test_a_table_is_diagnosed_by_its_motors_columns(tmp_path: Path) -> None:
    record = recording()
    channels = ChannelNames(currents=("1", "2", "3"), phase_voltages=("4", "5", "6"))
    scaling = TableScaling(sample_rate_hz=4000.0, current_scale=(0.1,) * 3, voltage_scale=(10.0,) * 3)
    factors = np.repeat([0.1, 10.0], 3)[:, np.newaxis]
    np.save(tmp_path / "PUMP_20260131T120000.NPY", record.samples / factors)
    (tmp_path / "PUMP_20260131T120000.NPY.npy").rename(tmp_path / "PUMP_20260131T120000.NPY")
    asked = task(tmp_path / "PUMP_20260131T120000.NPY")
    outcome = diagnose_recording(
        replace(asked, motor=replace(asked.motor, channels=channels, tables=scaling))
    )
    by_relay = diagnose_recording(task(write(tmp_path / "EVENT", record)))
    assert isinstance(outcome, Diagnosed)
    assert isinstance(by_relay, Diagnosed)
    assert outcome.recorded_ns == nanoseconds("2026-01-31T12:00:00Z")
    assert outcome.findings.diagnosis.verdict is by_relay.findings.diagnosis.verdict
    assert isinstance(diagnose_recording(asked), Rejected), "without the motor's columns there is no rate"


def test_a_start_is_measured(tmp_path: Path) -> None:
    start = StartRecord(load_level=0.5).of(REFERENCE)
    asked = task(write(tmp_path / "START", start))
    outcome = diagnose_recording(replace(asked, motor=REFERENCE))
    assert isinstance(outcome, Diagnosed)
    assert outcome.findings.start is not None
    measured = measure_start(start, REFERENCE)
    assert outcome.findings.start.figures.acceleration_s == pytest.approx(measured.acceleration_s, rel=0.01)
    assert outcome.findings.start.figures.i2t_A2s == pytest.approx(measured.i2t_A2s, rel=0.01)
    assert outcome.findings.start.torque is not None
    assert outcome.findings.start.parameters is not None


def test_a_record_that_is_no_start_has_nothing_measured_of_one(tmp_path: Path) -> None:
    outcome = diagnose_recording(task(write(tmp_path / "EVENT", recording())))
    assert isinstance(outcome, Diagnosed)
    assert outcome.findings.start is None


def test_a_record_tells_of_rotor_and_supply(tmp_path: Path) -> None:
    record = waveforms(running(REFERENCE, 0.6), noise=0.002)
    outcome = diagnose_recording(replace(task(written(tmp_path / "EVENT", record)), motor=REFERENCE))
    assert isinstance(outcome, Diagnosed)
    assert outcome.findings.rotor is not None
    assert outcome.findings.rotor.slip == pytest.approx(0.032, abs=0.002)
    assert outcome.findings.supply is not None
    assert outcome.findings.supply.frequency_hz == pytest.approx(50.0, abs=0.01)


def test_a_record_in_local_time_is_diagnosed_as_of_utc(tmp_path: Path) -> None:
    local = replace(recording(), start_time_ns=nanoseconds("2026-10-25T02:30:00Z"))
    entry = write(tmp_path / "EVENT", local)
    near_ns = nanoseconds("2026-10-25T01:30:02Z")
    outcome = diagnose_recording(replace(task(entry), time_zone="Europe/Berlin", near_ns=near_ns))
    assert isinstance(outcome, Diagnosed)
    assert outcome.recorded_ns == nanoseconds("2026-10-25T01:30:00.1Z")
    assert outcome.findings.observation is None or outcome.findings.observation.time_ns == outcome.recorded_ns
    told = [finding.message for finding in outcome.findings.diagnosis.quality]
    assert "time: 2026-10-25 02:30:00 is there twice in Europe/Berlin: the second is taken" in told


def test_a_recording_that_would_not_fit_into_memory_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.jobs.worker.MOST_VALUES", 19_999)
    outcome = diagnose_recording(task(write(tmp_path / "LONG", recording())))
    assert isinstance(outcome, Rejected)
    assert "at most 19999 values" in outcome.reason


def test_what_would_fail_again_is_rejected(tmp_path: Path) -> None:
    without_voltages = write(tmp_path / "CURRENTS", recording(voltages=False))
    truncated = write(tmp_path / "SHORT", recording())
    samples = truncated.with_suffix(".DAT")
    samples.write_bytes(samples.read_bytes()[:-10])
    unknown_method = task(write(tmp_path / "EVENT", recording()), method="guess")
    outcomes = [diagnose_recording(t) for t in (task(without_voltages), task(truncated), unknown_method)]
    reasons = [outcome.reason for outcome in outcomes if isinstance(outcome, Rejected)]
    assert len(reasons) == 3
    assert "voltages" in reasons[0]
    assert "SHORT" in reasons[1]
    assert "'guess' is unknown" in reasons[2]


@pytest.mark.timeout(300)
def test_worker_processes_diagnose(repository: Repository, store: RecordingStore, tmp_path: Path) -> None:
    entry = write(tmp_path / "EVENT", recording())
    stored = store.store({path.name: path for path in (entry, entry.with_suffix(".DAT"))})
    added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS)
    motors = {"PUMP-A1": motor("PUMP-A1")}
    runner = JobRunner(
        repository,
        store,
        motors,
        diagnose_recording,
        limits=JobLimits(
            workers=1, job_timeout_s=120.0, attempts=3, backoff=Backoff(2.0, 60.0), lease_s=30.0
        ),
        installation="ours",
        prepare_worker=prepare_worker,
    )
    runner.start()
    try:
        wait_until(lambda: repository.current_diagnosis(added.recording.id), within_s=120)
    finally:
        runner.stop()
    health = repository.health("PUMP-A1")
    assert health.diagnosis is not None
    assert health.diagnosis.verdict in set(Verdict)
    assert health.diagnosis.recorded_ns == NOW_NS + TRIGGER_INDEX * 250_000


def written(path: Path, record: Recording) -> Path:
    channels = tuple(
        replace(channel, full_scale=2.0 * float(np.abs(x).max()))
        for channel, x in zip(record.channels, record.samples, strict=True)
    )
    return write(path, replace(record, channels=channels))


def test_what_the_baseline_shows_is_taken_off(tmp_path: Path) -> None:
    def record(name: str, load_level: float) -> Path:
        """A healthy motor whose relay reads phase b 3 % high."""
        operation = running(REFERENCE, load_level)
        gains, seed = (1.0, 1.03, 1.0), round(100 * load_level)
        return written(tmp_path / name, waveforms(operation, noise=0.002, current_gains=gains, seed=seed))

    healthy = tuple(LocalFile(record(f"OK{k}", load_level)) for k, load_level in enumerate((0.3, 0.6, 0.9)))
    alone = DiagnosisTask(LocalFile(record("NEW", 0.5)), REFERENCE, "evidence", "coil")
    outcomes = [diagnose_recording(one) for one in (alone, replace(alone, baseline=healthy))]
    apparent, relative = (one.findings.diagnosis for one in outcomes if isinstance(one, Diagnosed))
    assert apparent.mu_f is not None
    assert relative.mu_f is not None
    assert relative.mu_f < 0.3 * apparent.mu_f
    assert "relative to a baseline of 3 healthy recordings" in relative.reasons


def test_a_baseline_that_cannot_be_learnt_rejects_with_its_reason(tmp_path: Path) -> None:
    entry = write(tmp_path / "EVENT", recording())
    baseline = (LocalFile(entry), LocalFile(tmp_path / "GONE.CFG"), LocalFile(entry))
    outcome = diagnose_recording(replace(task(entry), baseline=baseline))
    assert isinstance(outcome, Rejected)
    assert "the motor's baseline cannot be learnt" in outcome.reason


def test_a_worker_starts_without_the_database() -> None:
    names = "service.jobs.worker_process, service.jobs.worker, service.jobs.task"
    program = f"import sys, {names}; sys.exit('sqlalchemy' in sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)


def test_the_services_own_process_goes_without_the_compiler() -> None:
    program = "import sys, service.application.serve; sys.exit('numba' in sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)
