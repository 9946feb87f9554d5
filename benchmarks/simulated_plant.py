"""What the simulator costs: python -m benchmarks.simulated_plant [RELAYS]

Relays of one process, made of the relay's ICD: time to start, memory, share of a core while idle, without
and with a client each; time to read 20 MB of SCD, and to simulate 10 s of six channels at 10 kHz.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from lxml import etree

from ied_sim import warm_up
from ied_sim.scenario import healthy_reference
from mms import Client
from scl import SEL710_ICD, Address, read
from scl.document import Document
from scl.instantiation import rename_ied, set_address, write

HOST = "127.0.0.1"
FIRST_PORT = 20_100
SETTLING_S = 10.0
IDLE_S = 20.0
PAGE = 4096
RELAYS_OF_20_MB = 930


def plant_of(relays: int, path: Path) -> None:
    """An SCD of so many relays on loopback."""
    plant = Document(SEL710_ICD)
    _, communication, template, types = plant.root
    for element in (communication, template, types):
        plant.root.remove(element)
    network = plant.add(plant.root, "Communication")
    subnetwork = plant.add(network, "SubNetwork", name="S", type="8-MMS")
    for k in range(relays):
        relay = Document(SEL710_ICD)
        name = f"R{k + 1:03d}"
        rename_ied(relay, name)
        set_address(relay, name, Address(HOST, FIRST_PORT + k))
        subnetwork.append(next(relay.descendants(relay.root, "ConnectedAP")))
        plant.root.append(next(relay.children(relay.root, "IED")))
    plant.root.append(types)
    etree.indent(plant.root)
    write(plant, path)


def cpu_s(process_id: int) -> float:
    """CPU time a process has used [s]."""
    fields = Path(f"/proc/{process_id}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def resident_mb(process_id: int) -> float:
    pages = int(Path(f"/proc/{process_id}/statm").read_text(encoding="ascii").split()[1])
    return pages * PAGE / 1e6


def serve(relays: int, directory: Path) -> None:
    scd = directory / "plant.scd"
    plant_of(relays, scd)
    begin_s = time.monotonic()
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            while process.stdout.readline().strip() != "ready":
                assert process.poll() is None, "the simulator ended before it was ready"
            print(
                f"{relays} relays: ready after {time.monotonic() - begin_s:.1f} s, "
                f"{cpu_s(process.pid):.1f} s of them CPU; file of {scd.stat().st_size / 1e6:.1f} MB"
            )
            share = _idle_share(process.pid)
            print(f"idle, nobody connected: {share:.1f} % of a core, {resident_mb(process.pid):.0f} MB")
            clients = [Client.connect(HOST, FIRST_PORT + k) for k in range(relays)]
            share = _idle_share(process.pid)
            print(f"idle, a client each:    {share:.1f} % of a core, {resident_mb(process.pid):.0f} MB")
            for client in clients:
                client.close()
        finally:
            process.terminate()
            process.wait(30)


def _idle_share(process_id: int) -> float:
    time.sleep(SETTLING_S)
    before_s, begin_s = cpu_s(process_id), time.monotonic()
    time.sleep(IDLE_S)
    return 100 * (cpu_s(process_id) - before_s) / (time.monotonic() - begin_s)


def simulate() -> None:
    plant = healthy_reference("bench").plant
    for name, run in (
        ("10 s of six channels at 10 kHz, running", lambda: plant.window(100.0, 10.0, 10_000.0)),
        ("10 s of six channels at 10 kHz, from rest", lambda: plant.start_up(0.0, 10.0, 10_000.0)),
    ):
        run()
        begin_s = time.process_time()
        run()
        print(f"{name}: {time.process_time() - begin_s:.2f} s CPU")


def read_large(directory: Path) -> None:
    """An SCD of 20 MB, as `mcc import-scl` and the simulator read it."""
    scd = directory / "large.scd"
    plant_of(RELAYS_OF_20_MB, scd)
    begin_s, process_s = time.monotonic(), time.process_time()
    found = len(read(scd).ieds)
    print(
        f"{scd.stat().st_size / 1e6:.1f} MB of SCD, {found} relays: read in "
        f"{time.monotonic() - begin_s:.1f} s, {time.process_time() - process_s:.1f} s CPU"
    )


def main() -> None:
    relays = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    warm_up()
    simulate()
    with tempfile.TemporaryDirectory(prefix="statorwatch-bench-") as directory:
        read_large(Path(directory))
        serve(relays, Path(directory))


if __name__ == "__main__":
    main()
