"""Workers' hosts: from a fault until the record whose job the lost host had is diagnosed by another."""

import os
import signal
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import count

from sqlalchemy import select
from sqlalchemy.orm import Session

from benchmarks.takeover.hosts import Fault, Host, Site, freeze_inside_a_transaction, require_once
from core.recordings.comtrade.writer import combined_bytes
from core.units import NANOSECONDS_PER_HOUR
from service.recording_store.folder import FolderStore
from service.storage.models import DiagnosisRow, JobRow
from service.storage.records import JobRunnerEntry
from service.storage.states import JobState, RecordingState
from testing.service.processes import MOTOR_NAMES
from testing.service.real_recordings import running_record
from testing.waiting import wait_until

START_LIMIT_S = 120.0
WORK_LIMIT_S = 60.0
LEASES = 4
"""Others take over within so many leases, and a time in which a busy machine does its work."""
STOOD_STILL = "this process stood still inside a transaction"
AT_ONCE = 6
"""Records that are queued together: enough that each runner has one."""


def take_over_times(site: Site, repeats: int, command: str) -> Iterator[tuple[Fault, float]]:
    """Yield each fault with the time until the record of the lost host's job was diagnosed [s].

    command: of `mcc`, what the hosts run.
    Raises AssertionError where a record is lost or diagnosed twice.
    """
    records = Records(site)
    with site.hosts(command) as hosts:
        for fault in Fault:
            for number in range(repeats):
                yield fault, _take_over(site, records, hosts, hosts[number % len(hosts)], fault)


class Records:
    """Records of running motors, each another, added to the service's store and queued for diagnosis."""

    def __init__(self, site: Site) -> None:
        self._repository = site.repository
        self._store = FolderStore(site.recordings, "benchmark")
        self._numbers = count(1)
        self._begin_ns = time.time_ns()
        self.ids: list[str] = []
        self._open: list[str] = []

    def add(self, number_added: int = AT_ONCE) -> None:
        """Queue some more."""
        for _ in range(number_added):
            number = next(self._numbers)
            record = running_record(seconds=0.3, begin_ns=self._begin_ns - number * NANOSECONDS_PER_HOUR)
            stored = self._store.store({"EVENT.CFF": combined_bytes(record, data_format="BINARY")})
            motor = MOTOR_NAMES[number % len(MOTOR_NAMES)]
            added = self._repository.add_recording(stored, motor=motor, now_ns=time.time_ns())
            self.ids.append(added.recording.id)
            self._open.append(added.recording.id)

    def are_diagnosed(self) -> bool:
        """Whether all are."""
        self._open = [
            one for one in self._open if self._repository.recording(one).state is not RecordingState.DIAGNOSED
        ]
        return not self._open


def _take_over(site: Site, records: Records, hosts: Sequence[Host], lost: Host, fault: Fault) -> float:
    wait_until(lambda: all(runner_of(site, host) for host in hosts), "hosts with runners", START_LIMIT_S)
    job, recording = _stop_at_work(site, records, lost)
    if fault is Fault.FROZEN_IN_TRANSACTION:  # its result is about to be stored
        freeze_inside_a_transaction(site.engine, lost, select(JobRow.id).where(JobRow.id == job))
    else:
        lost.strike(fault)
    began_s = time.monotonic()
    if fault is Fault.CUT_OFF:
        os.kill(lost.process_ids[0], signal.SIGCONT)
    try:
        within_s = LEASES * site.lease_s + WORK_LIMIT_S
        wait_until(
            lambda: site.repository.recording(recording).state is RecordingState.DIAGNOSED,
            f"the diagnosis of {recording}",
            within_s,
        )
        took_s = time.monotonic() - began_s
    finally:
        lost.mend(fault)
    wait_until(lambda: runner_of(site, lost) is not None, f"{lost.name} to work again", START_LIMIT_S)
    wait_until(records.are_diagnosed, "the diagnoses of all records", WORK_LIMIT_S)
    if fault is Fault.FROZEN_IN_TRANSACTION:
        assert STOOD_STILL in lost.log.read_text(), f"{lost.log}: expected that it tells why it begins anew"
    _require_each_once(site, records, job)
    return took_s


def _stop_at_work(site: Site, records: Records, host: Host) -> tuple[str, str]:
    """Stop a host's own process while it has a job; return the job and its recording."""
    found: list[tuple[str, str]] = []

    def is_stopped() -> bool:
        if records.are_diagnosed():
            records.add()
        found.extend(_stopped_at_work(site, host))
        return bool(found)

    wait_until(is_stopped, f"{host.name} to have a job", START_LIMIT_S)
    return found[0]


def _stopped_at_work(site: Site, host: Host) -> list[tuple[str, str]]:
    """Stop a host's own process and return its jobs; where it has none, it goes on."""
    own = host.process_ids[0]
    os.kill(own, signal.SIGSTOP)
    runner = runner_of(site, host)
    if runner is not None:
        with Session(site.engine) as session:
            under_way = select(JobRow.id, JobRow.recording_id).where(
                JobRow.runner == runner.id, JobRow.state == JobState.RUNNING
            )
            if found := [(job, recording) for job, recording in session.execute(under_way)]:
                return found
    os.kill(own, signal.SIGCONT)
    return []


def runner_of(site: Site, host: Host) -> JobRunnerEntry | None:
    """The job runner of a host; None where it has none, or has lost it."""
    own = host.process_ids[0]
    return next((one for one in site.repository.job_runners() if one.process_id == own), None)


def _require_each_once(site: Site, records: Records, taken_over: str) -> None:
    """Raise AssertionError unless each record has one diagnosis, and the job was begun by two hosts."""
    with Session(site.engine) as session:
        diagnoses = Counter(session.scalars(select(DiagnosisRow.recording_id)))
        job = session.get_one(JobRow, taken_over)
    require_once("recording diagnosed", records.ids, diagnoses)
    assert job.attempts == 2, f"job {taken_over}: expected 2 attempts, found {job.attempts}"
