"""Our client, and the whole service, against the example servers in C."""

import hashlib
import io
import queue
import tempfile
from collections.abc import Iterator
from pathlib import Path

import scl
from benchmarks.interoperability.peers import Result, Tree, c_server
from mms import AssociationRejected, Client, FunctionalConstraint, Report
from scl import Address
from service.client.rest_client import ServiceClient
from testing.ports import LOOPBACK, free_port
from testing.service import processes
from testing.service.processes import RELAYS, all_recordings, running_service
from testing.service.small_record import CFG, DAT
from testing.waiting import eventually

FILES, CONTROLS, VALUES, PASSWORD = (
    f"server_example_{what}" for what in ("files", "control", "basic_io", "password_auth")
)
LOGICAL_DEVICE = "simpleIOGenericIO"
LARGE_FILE_BYTES = 3_000_000
MANY_FILES = 300
CONTROL_MODELS = (
    "direct-with-normal-security",
    "sbo-with-normal-security",
    "direct-with-enhanced-security",
    "sbo-with-enhanced-security",
)
REPORT_BLOCKS = ("LLN0.RP.EventsRCB01", "LLN0.BR.EventsBRCB01", "LLN0.BR.Measurements01")
REPORT_PATIENCE_S = 10.0
SERVICE_START_LIMIT_S = 300.0


def results(tree: Tree) -> Iterator[Result]:
    """Every check, in order."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-interoperability-") as name:
        directory = Path(name)
        with c_server(tree, VALUES) as port, Client.connect(LOOPBACK, port) as client:
            yield _browsed(client)
            yield _read(client)
            yield from (_reported(client, block) for block in REPORT_BLOCKS)
        with c_server(tree, CONTROLS) as port, Client.connect(LOOPBACK, port) as client:
            yield from (_operated(client, number) for number in range(1, len(CONTROL_MODELS) + 1))
        events = _file_store(directory)
        with c_server(tree, FILES, directory) as port:
            with Client.connect(LOOPBACK, port) as client:
                yield _listed(client, events)
                yield _fetched(client, events)
            yield _collected(directory, port, events)
        with c_server(tree, PASSWORD) as port:
            yield _refused(port)


def _browsed(client: Client) -> Result:
    objects = sum(
        len(client.data_objects(f"{device}/{node}"))
        for device in client.logical_devices()
        for node in client.logical_nodes(device)
    )
    return Result(VALUES, "browse", f"{objects} data objects", objects > 0)


def _read(client: Client) -> Result:
    found = client.read(f"{LOGICAL_DEVICE}/GGIO1.AnIn1.mag.f", FunctionalConstraint.MX)
    members = client.read_data_set(f"{LOGICAL_DEVICE}/LLN0.Events")
    passed = isinstance(found, float) and len(members) > 0
    return Result(VALUES, "read a value and a data set", f"AnIn1, {len(members)} members", passed)


def _reported(client: Client, block: str) -> Result:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    reference = f"{LOGICAL_DEVICE}/{block}"
    client.subscribe(reference, reports, general_interrogation=True)
    try:
        report = reports.get(timeout=REPORT_PATIENCE_S)
    except queue.Empty:
        return Result(VALUES, f"reports of {block}", "none came", passed=False)
    finally:
        client.unsubscribe(reference)
    return Result(
        VALUES, f"reports of {block}", f"a report of {len(report.members)} members", len(report.members) > 0
    )


def _operated(client: Client, number: int) -> Result:
    control = f"{LOGICAL_DEVICE}/GGIO1.SPCSO{number}"
    seen = []
    for state in (True, False):
        client.operate(control, state)
        seen.append(client.read(f"{control}.stVal", FunctionalConstraint.ST))
    return Result(
        CONTROLS,
        f"operate, {CONTROL_MODELS[number - 1]}",
        f"status {seen}",
        seen == [True, False],
    )


def _file_store(directory: Path) -> Path:
    """What the file server serves: a record and a large file in EVENTS, and a folder of many files."""
    events = directory / "vmd-filestore" / "EVENTS"
    events.mkdir(parents=True)
    (events / "HR_10001.CFG").write_bytes(CFG)
    (events / "HR_10001.DAT").write_bytes(DAT)
    (events / "LARGE.BIN").write_bytes(hashlib.shake_128(b"large").digest(LARGE_FILE_BYTES))
    many = directory / "vmd-filestore" / "MANY"
    many.mkdir()
    for number in range(MANY_FILES):
        (many / f"FILE_{number:05d}_WITH_A_NAME_OF_SOME_LENGTH.TXT").write_bytes(bytes(number % 7))
    return events


def _listed(client: Client, events: Path) -> Result:
    folders = [events, events.parent / "MANY"]
    expected = {(path.name, path.stat().st_size) for folder in folders for path in folder.iterdir()}
    listed = {
        (entry.name.rpartition("/")[2], entry.size)
        for folder in folders
        for entry in client.files(folder.name)
    }
    return Result(FILES, "list two folders", f"{len(listed)} names and sizes", listed == expected)


def _fetched(client: Client, events: Path) -> Result:
    same = 0
    for path in events.iterdir():
        content = io.BytesIO()
        client.download(f"EVENTS/{path.name}", content, expected_size=path.stat().st_size)
        same += _sha256(content.getvalue()) == _sha256(path.read_bytes())
    number = len(list(events.iterdir()))
    return Result(FILES, "fetch files", f"SHA-256 of {same} of {number} equal", same == number)


def _collected(directory: Path, port: int, events: Path) -> Result:
    """The whole service, as a process: the C server stands where the demo plant's first relay would."""
    processes.START_LIMIT_S = SERVICE_START_LIMIT_S
    scd = directory / "plant.scd"
    addresses = {relay: Address(LOOPBACK, free_port()) for relay in RELAYS}
    scl.with_addresses(scl.DEMO_PLANT_SCD, scd, addresses | {RELAYS[0]: Address(LOOPBACK, port)})
    with (
        running_service(directory, scd, MCC_POLL_PERIOD_S="0.5") as service,
        ServiceClient(service.url) as client,
    ):
        stored = eventually(lambda: any(each["state"] != "announced" for each in all_recordings(client)), 60)
        kept = {
            path.name: _sha256(path.read_bytes()) for path in (service.data / "recordings").rglob("HR_*.*")
        }
    expected = {path.name: _sha256(path.read_bytes()) for path in events.glob("HR_*.*")}
    return Result(
        FILES, "the service pulls a record", f"{len(kept)} files stored", stored and kept == expected
    )


def _refused(port: int) -> Result:
    """It lets in only who gives a password."""
    try:
        Client.connect(LOOPBACK, port).close()
    except AssociationRejected as error:
        return Result(PASSWORD, "associate without a password", error.message, passed=True)
    return Result(PASSWORD, "associate without a password", "let in", passed=False)


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
