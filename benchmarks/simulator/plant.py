"""What the simulator costs: python -m benchmarks.simulator.plant [RELAYS].

Relays of one process, made of the relay's ICD: time to start, memory, share of a core while idle, without
and with a client each; time to read 20 MB of SCD, and to simulate 10 s of six channels at 10 kHz.
"""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from lxml import etree

from ied_sim import warm_up
from ied_sim.scenario.scenario import healthy_reference
from mms import Client
from scl import SEL710_ICD, Address, read
from scl.document import Document
from scl.instantiation import GOOSE_ADDRESSES, number_goose, rename_ied, set_address, write
from service.demo.addresses import free_ports

HOST = "127.0.0.1"
RELAYS = 200
SETTLING_S = 10.0
IDLE_S = 20.0
PAGE = 4096
RELAYS_OF_20_MB = 930
LIMITS = "limits for 200 relays: ready in 10 s, 400 MB, 30 % of a core idle"


def measure(relays: int = RELAYS) -> Iterator[str]:
    warm_up()
    yield from _simulate()
    with tempfile.TemporaryDirectory(prefix="statorwatch-bench-") as directory:
        yield from _read_large(Path(directory))
        yield LIMITS
        yield from _serve(relays, Path(directory))


def plant_of(ports: Sequence[int], path: Path, *, first: int = 1) -> None:
    """An SCD of a relay for each port on loopback. first: number of the first relay."""
    plant = Document(SEL710_ICD)
    _, communication, template, types = plant.root
    for element in (communication, template, types):
        plant.root.remove(element)
    network = plant.add(plant.root, "Communication")
    subnetwork = plant.add(network, "SubNetwork", name="S", type="8-MMS")
    for number, port in enumerate(ports, first):
        relay = Document(SEL710_ICD)
        name = f"R{number:03d}"
        rename_ied(relay, name)
        set_address(relay, name, Address(HOST, port))
        number_goose(relay, number % GOOSE_ADDRESSES)
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


def _serve(relays: int, directory: Path) -> Iterator[str]:
    scd = directory / "plant.scd"
    ports = free_ports(relays)
    plant_of(ports, scd)
    begin_s = time.monotonic()
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            while process.stdout.readline().strip() != "ready":
                assert process.poll() is None, "the simulator ended before it was ready"
            yield (
                f"{relays} relays: ready after {time.monotonic() - begin_s:.1f} s, "
                f"{cpu_s(process.pid):.1f} s of them CPU; file of {scd.stat().st_size / 1e6:.1f} MB"
            )
            share = _idle_share(process.pid)
            yield f"idle, nobody connected: {share:.1f} % of a core, {resident_mb(process.pid):.0f} MB"
            clients = [Client.connect(HOST, port) for port in ports]
            share = _idle_share(process.pid)
            yield f"idle, a client each:    {share:.1f} % of a core, {resident_mb(process.pid):.0f} MB"
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


def _simulate() -> Iterator[str]:
    plant = healthy_reference("bench").plant
    for name, run in (
        ("running", lambda: plant.window(100.0, 10.0, 10_000.0)),
        ("from rest", lambda: plant.start_up(0.0, 10.0, 10_000.0)),
    ):
        run()
        begin_s = time.process_time()
        run()
        taken_s = time.process_time() - begin_s
        yield f"10 s of six channels at 10 kHz, {name}: {taken_s:.2f} s CPU (limit 2 s)"


def _read_large(directory: Path) -> Iterator[str]:
    """An SCD of 20 MB, as `mcc import-scl` and the simulator read it."""
    scd = directory / "large.scd"
    plant_of(range(20_000, 20_000 + RELAYS_OF_20_MB), scd)
    begin_s, process_s = time.monotonic(), time.process_time()
    found = len(read(scd).ieds)
    yield (
        f"{scd.stat().st_size / 1e6:.1f} MB of SCD, {found} relays: read in "
        f"{time.monotonic() - begin_s:.1f} s, {time.process_time() - process_s:.1f} s CPU (limit 5 s)"
    )


if __name__ == "__main__":
    for line in measure(int(sys.argv[1]) if len(sys.argv) > 1 else RELAYS):
        print(line, flush=True)
