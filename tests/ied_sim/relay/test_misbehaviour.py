"""What a relay does wrong on request, as its clients see it."""

import io
import queue
import socket
import time
from pathlib import Path

import pytest

from core.recordings import read
from ied_sim.errors import SimulatorError
from ied_sim.misbehaviour import PARAMETERS, Kind, Misbehaviour
from mms import (
    AddCause,
    Client,
    ConnectFailed,
    ControlRefused,
    FileSizeMismatch,
    FunctionalConstraint,
    MmsError,
    Report,
    ReportControlInUse,
    Timestamp,
    Value,
)
from testing.relays.simulated import IED, Simulated, fetch, names, scenario_of, simulated, text
from testing.waiting import wait_until

TRIGGER = f"{IED}CON/RBGGIO1.SPCSO01"
NUMBER = f"{IED}PRO/FLTRDRE1.FltNum.stVal"
SWITCH = "CON/RBGGIO1.SPCSO30"
REPORTS = f"{IED}CFG/LLN0.BR.BRep01"


def by_switch(kind: Kind, number: float | None = None, for_s: float = float("inf")) -> Misbehaviour:
    """Of this kind while RB30 is set."""
    default = PARAMETERS.get(kind, ("", 0.0))[1]
    return Misbehaviour(kind, default if number is None else number, switch=SWITCH, for_s=for_s)


def value(client: Client, reference: str) -> Value:
    return client.read(reference, FunctionalConstraint.ST)


def switch(client: Client, *, on: bool) -> None:
    client.operate(f"{IED}{SWITCH}", value=on)


def make_record(served: Simulated, client: Client) -> None:
    before = served.relay._archive.last_number
    client.operate(TRIGGER, value=True)
    client.operate(TRIGGER, value=False)
    wait_until(lambda: served.relay._archive.last_number != before, "a record")


def test_replies_come_late_while_it_is_switched_on(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.SLOW_REPLIES, 0.4))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        switch(client, on=True)
        begin_s = time.monotonic()
        client.read(f"{TRIGGER}.stVal", FunctionalConstraint.ST)
        assert time.monotonic() - begin_s >= 0.4
        switch(client, on=False)


def test_a_connection_is_cut_in_the_middle_of_a_file(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.CUT_MID_FILE, 100))
    with simulated(tmp_path, scenario) as served:
        with served.client() as client:
            make_record(served, client)
            name, size = next((e.name, e.size) for e in client.files("EVENTS") if e.name.endswith("DAT"))
            switch(client, on=True)
            with pytest.raises(MmsError):
                client.download(name, io.BytesIO(), expected_size=size)
            assert client.wait_closed(5)
        with served.client() as client:
            switch(client, on=False)
            assert client.download(name, io.BytesIO(), expected_size=size) == size


def test_a_file_grows_while_it_is_read(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", Misbehaviour(Kind.GROWING_FILE, 0.6, at_s=0.0))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        client.operate(TRIGGER, value=True)
        sizes = set()

        def data_size() -> int | None:
            found = [entry.size for entry in client.files("EVENTS") if entry.name.endswith("DAT")]
            sizes.update(found)
            return found[0] if found else None

        wait_until(lambda: data_size() is not None, "a record")
        early = data_size()
        wait_until(lambda: data_size() == 192 * (8 + 12 + 2), "the file to be whole")
        assert len(sizes) > 2
        with pytest.raises(FileSizeMismatch):
            client.download("EVENTS/HR_10000.DAT", io.BytesIO(), expected_size=early)


def test_listings_come_in_parts(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", Misbehaviour(Kind.PARTIAL_LISTING, 2, at_s=0.0))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        make_record(served, client)
        make_record(served, client)
        assert len(names(client, "EVENTS")) == 6
        assert len(names(client, "REPORTS")) == 8
        assert len(fetch(client, "EVENTS", tmp_path / "fetched")) == 6


def test_a_listing_tells_wrong_sizes(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.WRONG_SIZE, -5))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        make_record(served, client)
        true = {entry.name: entry.size for entry in client.files("EVENTS")}
        switch(client, on=True)
        assert {entry.name: entry.size + 5 for entry in client.files("EVENTS")} == true
        with pytest.raises(FileSizeMismatch):
            fetch(client, "EVENTS", tmp_path / "fetched")


def test_names_come_without_their_path_or_with_it(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.NAMES_WITHOUT_PATH))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        make_record(served, client)
        assert names(client, "EVENTS")[0] == "EVENTS/HR_10000.CFG"
        switch(client, on=True)
        assert names(client, "EVENTS") == [f"HR_10000.{suffix}" for suffix in ("CFG", "DAT", "HDR")]
        configuration = fetch(client, "EVENTS", tmp_path / "fetched")[0]
        assert read(configuration).samples.shape == (6, 192)


def test_another_client_has_the_report_block(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.REPORT_TAKEN))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        switch(client, on=True)
        misbehaviour = served.relay._misbehaviour
        wait_until(lambda: misbehaviour._other_client is not None, "the other client")
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        assert _refused(client, reports)
        switch(client, on=False)
        wait_until(lambda: misbehaviour._other_client is None, "the other client to leave")
        wait_until(lambda: not _refused(client, reports), "the block to be free, which takes a while")


def _refused(client: Client, reports: "queue.SimpleQueue[Report]") -> bool:
    try:
        client.subscribe(REPORTS, reports)
    except ReportControlInUse:
        return True
    client.unsubscribe(REPORTS)
    return False


def test_the_report_buffer_overflows(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.BUFFER_OVERFLOW))
    with simulated(tmp_path, scenario) as served:
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        with served.client() as client:
            client.subscribe(REPORTS, reports)
            make_record(served, client)
            switch(client, on=True)
            entry = reports.get(timeout=60).entry_id
        wait_until(lambda: Kind.BUFFER_OVERFLOW in served.relay._misbehaviour._on, "the flood")
        with served.client() as client:
            later: queue.SimpleQueue[Report] = queue.SimpleQueue()
            overflowed = _overflowed(client, later, entry)
        assert overflowed


def _overflowed(client: Client, reports: "queue.SimpleQueue[Report]", entry: bytes | None) -> bool:
    """Either the entry is gone, or a report says that some are."""
    try:
        client.subscribe(REPORTS, reports, entry_id=entry)
    except MmsError:
        return True
    return any(reports.get(timeout=60).buffer_overflow for _ in range(3))


def test_reports_come_without_an_identifier(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", Misbehaviour(Kind.EMPTY_RPTID, at_s=0.0))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        client.subscribe(REPORTS, reports)
        client.operate(TRIGGER, value=True)
        report = reports.get(timeout=60)
        told_of = [member.reference for member in report.members]
        assert (report.report_id, "CON/RBGGIO1$ST$SPCSO01" in str(told_of)) == ("", True)


def test_a_block_keeps_its_identifier_while_a_client_has_it(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2", by_switch(Kind.EMPTY_RPTID))) as served:
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        with served.client() as client:
            client.subscribe(REPORTS, reports)
            switch(client, on=True)
            make_record(served, client)
            assert reports.get(timeout=20).report_id != ""
        with served.client() as client:
            client.subscribe(REPORTS, reports)
            make_record(served, client)
            wait_until(lambda: not reports.empty() and reports.get().report_id == "", "a report without")


@pytest.mark.parametrize(
    ("profile", "free", "meant"),
    [
        ("rdre", "Rec_FaultRecorder/MOTGGIO1.SPCSO03", "Rec_FaultRecorder/MOTGGIO1.SPCSO02"),
        ("rdre-readonly", "DR/MOTGGIO1.SPCSO04", "DR/MOTGGIO1.SPCSO01"),
        ("sel-710-ed1", "CON/RBGGIO1.SPCSO31", "CON/RBGGIO1.SPCSO01"),
    ],
)
def test_every_kind_of_relay_has_free_controls_to_switch_with(
    tmp_path: Path, profile: str, free: str, meant: str
) -> None:
    refused = Misbehaviour(Kind.REFUSED_CONTROL, switch=free)
    with simulated(tmp_path / "free", scenario_of(profile, refused)) as served, served.client() as client:
        client.operate(served.reference(free), value=True)
        with pytest.raises(ControlRefused):
            client.operate(served.reference(meant), value=True)
        assert not served.relay._word["STOPPED"]
    by_meant = scenario_of(profile, Misbehaviour(Kind.REFUSED_CONTROL, switch=meant))
    with (
        pytest.raises(SimulatorError, match=r"has a meaning of its own .*choose a free control"),
        simulated(tmp_path / "meant", by_meant),
    ):
        pass


def test_local_time_is_told_where_the_format_can_tell_it(tmp_path: Path) -> None:
    """COMTRADE 2013 has a time code, so that the times of its records are known in UTC after all."""
    local = Misbehaviour(Kind.LOCAL_TIME, -19_800.0, at_s=0.0)
    with simulated(tmp_path / "relay", scenario_of("rdre", local)) as served, served.client() as client:
        now_s = time.time()
        client.operate(served.reference("Rec_FaultRecorder/DEF_RDRE1.RcdTrg"), value=True)
        wait_until(lambda: len(names(client, "COMTRADE")) == 3, "a record")
        configuration = fetch(client, "COMTRADE", tmp_path / "fetched")[0]
    assert "\r\n-5h30,-5h30\r\n" in configuration.read_bytes().decode()
    assert read(configuration).trigger_time_ns * 1e-9 == pytest.approx(now_s, abs=5)


def test_the_clock_is_wrong_and_records_are_in_local_time(tmp_path: Path) -> None:
    wrong = Misbehaviour(Kind.CLOCK_OFFSET, -100.0, at_s=0.0)
    local = Misbehaviour(Kind.LOCAL_TIME, 7200.0, at_s=0.0)
    with simulated(tmp_path, scenario_of("sel-710-ed2", wrong, local)) as served, served.client() as client:
        now_s = time.time()
        make_record(served, client)
        stamp = client.read(f"{TRIGGER}.t", FunctionalConstraint.ST)
        assert isinstance(stamp, Timestamp)
        assert stamp.ns * 1e-9 == pytest.approx(now_s - 100, abs=5)
        recording = read(fetch(client, "EVENTS", tmp_path / "fetched")[0])
        assert recording.trigger_time_ns * 1e-9 == pytest.approx(now_s - 100 + 7200, abs=5)
        assert " local" in (tmp_path / "fetched" / "HR_10000.HDR").read_text()


def test_a_restart_forgets_the_reports_and_keeps_the_records(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.RESTART, for_s=0.5))
    with simulated(tmp_path, scenario) as served:
        reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        with served.client() as client:
            client.subscribe(REPORTS, reports)
            make_record(served, client)
            report = reports.get(timeout=60)
            switch(client, on=True)
            assert client.wait_closed(10)
        wait_until(lambda: _answers(served), "the relay to be back")
        with served.client() as client:
            with pytest.raises(MmsError):
                client.subscribe(REPORTS, reports, entry_id=report.entry_id)
            assert names(client, "EVENTS") == [f"EVENTS/HR_10000.{each}" for each in ("CFG", "DAT", "HDR")]
            assert client.read(f"{IED}PRO/FLTRDRE1.FltNum.stVal", FunctionalConstraint.ST) == 10000


def _answers(served: Simulated) -> bool:
    try:
        with served.client() as client:
            return bool(client.logical_devices())
    except MmsError:
        return False


def test_a_control_is_refused_with_a_reason(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.REFUSED_CONTROL))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        switch(client, on=True)
        with pytest.raises(ControlRefused) as refused:
            client.operate(TRIGGER, value=True)
        assert refused.value.add_cause == AddCause.BLOCKED_BY_INTERLOCKING.words
        switch(client, on=False)
        make_record(served, client)


def test_sessions_are_few(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", Misbehaviour(Kind.FEW_SESSIONS, 1, at_s=0.0))
    with simulated(tmp_path, scenario) as served, served.client(), pytest.raises(ConnectFailed):
        Client.connect(served.address.host, served.address.port, connect_timeout_s=1.0)


def client_once_free(served: Simulated) -> Client:
    """Connect as soon as a session is free: a server frees one a moment after its client has gone."""
    deadline_s = time.monotonic() + 20.0
    while True:
        try:
            return served.client()
        except ConnectFailed:
            if time.monotonic() > deadline_s:
                raise


def test_a_profile_s_sessions_are_all_there_are(tmp_path: Path) -> None:
    """A SEL relay has 7, two more than one server of the MMS library: all see the same relay."""
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served:
        clients = [served.client() for _ in range(7)]
        with pytest.raises(ConnectFailed):
            Client.connect(served.address.host, served.address.port, connect_timeout_s=1.0)
        first, *_, last = clients
        told: queue.SimpleQueue[Report] = queue.SimpleQueue()
        last.subscribe(REPORTS, told)
        make_record(served, first)
        assert told.get(timeout=20).members
        wait_until(lambda: {value(client, NUMBER) for client in clients} == {10_000}, "the record's number")
        make_record(served, last)
        wait_until(lambda: value(first, NUMBER) == 10_001, "the number of the last client's record")
        for client in (first, last):
            client.close()
        with client_once_free(served) as another:
            wait_until(lambda: value(another, NUMBER) == 10_001, "a session after others have ended")
        for client in clients[1:-1]:
            client.close()


def test_sessions_beyond_those_of_the_library_survive_a_restart_of_the_relay(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2", by_switch(Kind.RESTART, for_s=0.5))) as served:
        clients = [served.client() for _ in range(7)]
        switch(clients[6], on=True)
        wait_until(lambda: not any(client.is_open for client in clients), "the end of all sessions")
        for client in clients:
            client.close()
        wait_until(lambda: not served.relay._relay_server._down, "the relay's return")
        clients = [served.client() for _ in range(7)]
        assert {value(client, NUMBER) for client in clients} == {0}
        for client in clients:
            client.close()


def test_a_frozen_relay_stays_connected_and_answers_nothing(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.FROZEN, for_s=1.5))
    with simulated(tmp_path, scenario) as served, served.client(request_timeout_s=0.3) as client:
        with pytest.raises(MmsError):
            switch(client, on=True)
        with pytest.raises(MmsError):
            client.read(f"{TRIGGER}.stVal", FunctionalConstraint.ST)
        assert client.is_open
        wait_until(lambda: not served.relay.misbehaviour_state.is_on(Kind.FROZEN), "the thaw")
        wait_until(lambda: _answers(served), "an answer")


def test_nonsense_at_the_door_ends_that_connection_alone(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.SLOW_REPLIES))
    with simulated(tmp_path, scenario) as served:
        for octets in (b"GET / HTTP/1.1\r\n\r\n", b"\x03\x00\x00\x04", b"\x03\x00\x00\x07\x02\xf0\x80", b""):
            with socket.create_connection((served.address.host, served.address.port), timeout=5) as stranger:
                stranger.sendall(octets)
                stranger.shutdown(socket.SHUT_WR)
                while stranger.recv(1000):
                    pass
        with served.client() as client:
            assert client.logical_devices()
            assert "EMPTY" in text(client, "REPORTS/HISTORY.TXT").upper()
