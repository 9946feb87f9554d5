"""Every relay profile used over loopback, captured, and decoded by tshark.

    python -m benchmarks.interoperability.capture

Needs dumpcap and tshark (Debian package tshark) and the right to capture. One line a profile: frames, MMS
frames, and how many of them tshark calls malformed or in error.
"""

import queue
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from ied_sim.misbehaviour import Kind, Misbehaviour
from ied_sim.profiles.profile import shipped
from ied_sim.relay.configuration import RelayConfiguration
from mms import Client, Report
from testing.relays.simulated import IED, Simulated, fetch, scenario_of, simulated, text

FAULTS = ("_ws.malformed", '_ws.expert.severity == "Error"')
REWRITTEN = (Kind.PARTIAL_LISTING, Kind.WRONG_SIZE, Kind.EMPTY_RPTID)


def use(served: Simulated, scenario: RelayConfiguration, client: Client, directory: Path) -> None:
    """Browse, read, take reports, operate, fetch files."""
    points, files = scenario.profile.points, scenario.profile.files
    for device in client.logical_devices():
        for node in client.logical_nodes(device):
            client.data_objects(f"{device}/{node}")
    for data_set in served.document.ied(IED).data_sets():
        client.read_data_set(data_set.reference)
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    if points.reports is not None:
        client.subscribe(served.reference(points.reports), reports)
    for control in (*points.trigger[-1:], points.stop, points.start):
        if control is not None:
            client.operate(served.reference(control), value=True)
    time.sleep(1.5)
    if files is not None:
        for entry in client.files(""):
            if entry.name.endswith("TXT"):
                text(client, entry.name)
        if not scenario.misbehaviour:
            fetch(client, files.folder, directory)


def captured(scenario: RelayConfiguration, directory: Path) -> tuple[int, int, int]:
    """Frames, MMS frames and faulty frames of one use of a relay."""
    pcap = directory / "use.pcap"
    with simulated(directory / "relay", scenario) as served:
        port = served.address.port
        with subprocess.Popen(
            [_tool("dumpcap"), "-q", "-i", "lo", "-f", f"tcp port {port}", "-w", str(pcap)],
            stderr=subprocess.DEVNULL,
        ) as capture:
            time.sleep(2.0)
            with served.client() as client:
                use(served, scenario, client, directory / "fetched")
            time.sleep(1.0)
            capture.terminate()
    counts = [_count(pcap, port, chosen) for chosen in ("tcp", "mms", " or ".join(FAULTS))]
    return counts[0], counts[1], counts[2]


def _count(pcap: Path, port: int, chosen: str) -> int:
    command = [_tool("tshark"), "-r", str(pcap), "-d", f"tcp.port=={port},tpkt", "-Y", chosen]
    return len(subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines())


def _tool(name: str) -> str:
    found = shutil.which(name)
    if found is None:
        sys.exit(f"{name} is not installed: apt-get install tshark")
    return found


def main() -> int:
    rewritten = tuple(Misbehaviour(kind, 2.0, at_s=0.0) for kind in REWRITTEN)
    scenarios = {name: scenario_of(name) for name in shipped()}
    scenarios["sel-710-ed2, rewritten by its front"] = scenario_of("sel-710-ed2", *rewritten)
    faults = 0
    for name, scenario in scenarios.items():
        with tempfile.TemporaryDirectory(prefix="statorwatch-capture-") as directory:
            frames, mms, faulty = captured(scenario, Path(directory))
        print(f"{name}: {frames} frames, {mms} of MMS, {faulty} malformed or in error")
        faults += faulty + (mms == 0)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
