"""Client tools in C against every relay profile of the simulator, and our server with their SCL files."""

import hashlib
import io
import math
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import scl
from benchmarks.interoperability.peers import TOOL_LIMIT_S, Result, Tree, output
from ied_sim.profiles.profile import Profile, shipped
from mms import Client, ControlAction, FunctionalConstraint, Server
from scl.model_text import model_text
from testing.ports import LOOPBACK, free_port
from testing.relays.simulated import IED, Simulated, scenario_of, simulated

MMS_UTILITY, FILE_TOOL = "mms_utility", "file-tool"
CONTROL_CLIENT, REPORT_CLIENT = "client_example_control", "*client_example_reporting"
RECORD_PATIENCE_S = 30.0
REPORT_SECONDS = 2.0
STANDSTILL_A = 0.05
"""More than a meter shows of a stopped motor, far less than it draws."""
THEIR_IED = "simpleIO"
CONTROL_SCL, REPORT_SCL = "simpleIO_control_tests.cid", "simpleIO_direct_control.cid"


@dataclass(frozen=True)
class _Tools:
    """The tools, aimed at one relay."""

    tree: Tree
    c_client: Path
    directory: Path
    profile: Profile
    served: Simulated

    def utility(self, *options: str) -> str:
        address = ("-h", LOOPBACK, "-p", str(self.served.address.port))
        return output(self.tree.program(MMS_UTILITY), *address, *options).stdout

    def file_tool(self, *words: str) -> str:
        address = ("-h", LOOPBACK, "-p", str(self.served.address.port))
        return output(self.tree.program(FILE_TOOL), *address, *words, directory=self.directory).stdout

    def client(self, what: str, reference: str, number: str) -> str:
        return output(
            self.c_client, what, LOOPBACK, str(self.served.address.port), reference, number
        ).stdout.strip()


def results(tree: Tree) -> Iterator[Result]:
    """Every check of every profile, then of their own model."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-interoperability-") as name:
        directory = Path(name)
        c_client = tree.c_client(directory)
        for profile in shipped():
            scenario = scenario_of(profile)
            with simulated(directory / profile, scenario) as served:
                tools = _Tools(tree, c_client, directory, scenario.profile, served)
                yield from (check(tools) for check in CHECKS)
    yield _controls_of_their_own(tree)
    yield _reports_of_their_own(tree)


def _browsed(tools: _Tools) -> Result:
    devices = [device.name for device in tools.served.document.ied(IED).logical_devices]
    listing = tools.utility("-d")
    found = [device for device in devices if device in listing]
    variables = sum(tools.utility("-t", device).count("$") for device in devices)
    return Result(
        tools.profile.name, "mms_utility: browse", f"{len(found)} devices", found == devices and variables > 0
    )


def _read(tools: _Tools) -> Result:
    metering = tools.profile.points.metering
    device, _, node = tools.served.reference(str(metering)).partition("/")
    answer = tools.utility("-a", device, "-r", f"{node}$MX$A$phsA$cVal$mag$f")
    value = answer.strip().splitlines()[-1]
    return Result(tools.profile.name, "mms_utility: read a current", f"{value} A", "Read SUCCESS" in answer)


def _data_set(tools: _Tools) -> Result:
    data_set = tools.served.document.ied(IED).data_sets()[0].reference
    device, _, name = data_set.partition("/")
    answer = tools.utility("-a", device, "-z", name.replace(".", "$"))
    values = tools.utility("-a", device, "-v", name.replace(".", "$"))
    passed = "Read SUCCESS" in answer and "Read SUCCESS" in values
    return Result(tools.profile.name, "mms_utility: data set", f"{answer.count('[')} members", passed)


def _reported(tools: _Tools) -> Result:
    block = tools.profile.points.reports
    answer = tools.client("reports", tools.served.reference(str(block)), str(REPORT_SECONDS))
    number = answer.count("report ")
    passed = number > 0 and "error" not in answer
    return Result(
        tools.profile.name, "c_client: take reports", f"{number} of {block}" if passed else answer, passed
    )


def _operated(tools: _Tools) -> Result:
    """The motor's stop: every relay has it."""
    control = tools.served.reference(str(tools.profile.points.stop))
    answer = tools.client("operate", control, "1")
    with tools.served.client() as client:
        current = tools.served.reference(f"{tools.profile.points.metering}.A.phsA.cVal.mag.f")
        stopped = _comes_true(lambda: _amperes(client, current) < STANDSTILL_A)
    return Result(
        tools.profile.name, f"c_client: operate {control}", answer, answer == "operated" and stopped
    )


def _fetched(tools: _Tools) -> Result:
    """Let a record be made, then list and get every file of it."""
    of_profile = tools.profile
    if of_profile.files is None:
        answer = tools.file_tool("dir")
        return Result(tools.profile.name, "file-tool: list", answer.strip(), "Error retrieving" in answer)
    control = of_profile.points.trigger[0] if of_profile.points.trigger else of_profile.points.start
    tools.client("operate", tools.served.reference(str(control)), "1")
    folder = of_profile.files.folder
    with tools.served.client() as client:
        complete = _comes_true(lambda: any(entry.name.endswith(".CFG") for entry in client.files(folder)))
        listed = client.files(folder)
        told = tools.file_tool("subdir", folder)
        same = 0
        for entry in listed:
            content = io.BytesIO()
            client.download(entry.name, content, expected_size=entry.size)
            tools.file_tool("get", entry.name)
            copy = tools.directory / entry.name.rpartition("/")[2]
            same += _sha256(copy.read_bytes()) == _sha256(content.getvalue())
            copy.unlink()  # the next profile's may have the same name
    names = sum(f"{entry.name} {entry.size}" in told for entry in listed)
    return Result(
        tools.profile.name, "file-tool: list and get a record",
        f"{names} names, SHA-256 of {same} files equal",
        complete and names == same == len(listed),
    )  # fmt: skip


def _controls_of_their_own(tree: Tree) -> Result:
    """The model of their control example on our server, for their control client, which knows no other."""
    document = scl.read(tree.file(CONTROL_SCL))
    operated: list[str] = []
    server = Server(model_text(document, THEIR_IED), ied_name=THEIR_IED, port=free_port())

    def operate(action: ControlAction) -> bool:
        operated.append(action.reference)
        server.update(f"{action.reference}.stVal", action.value)
        return True

    controls = [f"{THEIR_IED}GenericIO/GGIO1.SPCSO{number}" for number in (1, 2, 3, 4, 9)]
    for control in controls:
        server.on_operate(control, operate)
    with server, Client.connect(LOOPBACK, server.port) as client:
        answer = output(tree.program(CONTROL_CLIENT), LOOPBACK, str(server.port)).stdout
        states = [client.read(f"{control}.stVal", FunctionalConstraint.ST) for control in controls[:4]]
    return Result(
        CONTROL_SCL, f"{CONTROL_CLIENT}: four control models", f"{len(operated)} operated",
        operated == controls and states == [True] * 4 and "failed" not in answer,
    )  # fmt: skip


def _reports_of_their_own(tree: Tree) -> Result:
    """The model of their basic example on our server, for their report client, which knows no other."""
    document = scl.read(tree.file(REPORT_SCL))
    port = free_port()
    with (
        Server(model_text(document, THEIR_IED), ied_name=THEIR_IED, port=port) as server,
        subprocess.Popen(
            [str(tree.program(REPORT_CLIENT)), LOOPBACK, str(port)], stdout=subprocess.PIPE, text=True
        ) as client,
    ):
        time.sleep(REPORT_SECONDS)
        server.update(f"{THEIR_IED}GenericIO/GGIO1.SPCSO1.stVal", value=True)
        time.sleep(REPORT_SECONDS)
        client.send_signal(signal.SIGINT)
        answer, _ = client.communicate(timeout=TOOL_LIMIT_S)
    number = answer.count("received report")
    changed = "SPCSO1.stVal[ST] (included for reason 1): true" in answer
    return Result(REPORT_SCL, REPORT_CLIENT, f"{number} reports, a change among them", changed and number > 1)


def _comes_true(condition: Callable[[], bool]) -> bool:
    deadline_s = time.monotonic() + RECORD_PATIENCE_S
    while not condition():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(0.1)
    return True


def _amperes(client: Client, reference: str) -> float:
    value = client.read(reference, FunctionalConstraint.MX)
    return value if isinstance(value, float) else math.inf


CHECKS = (_browsed, _read, _data_set, _reported, _operated, _fetched)


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
