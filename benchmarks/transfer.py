"""File transfer over MMS on loopback: a 20 MB file through our client, clear, in one run."""

import io
import socket
import tempfile
from collections.abc import Iterator
from pathlib import Path

import scl
from benchmarks.stopwatch import best_of
from mms import Client, Server, ServerPump
from scl.model_text import model_text

MEGABYTES = 20


def measure() -> Iterator[str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    plant = scl.read(scl.DEMO_PLANT_SCD)
    name = plant.ieds[0].name
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "EVENTS").mkdir()
        size = MEGABYTES * 1_000_000
        (root / "EVENTS" / "LARGE.DAT").write_bytes(bytes(size))
        server = Server(model_text(plant, name), ied_name=name, port=port, file_root=root)
        pump = ServerPump([server])
        pump.start()
        try:
            with Client.connect("127.0.0.1", port) as client:

                def download() -> int:
                    return client.download("EVENTS/LARGE.DAT", io.BytesIO(), expected_size=size)

                seconds = best_of(3, download)
        finally:
            pump.stop()
            server.stop()
    yield f"{MEGABYTES} MB in {seconds:.2f} s: {MEGABYTES / seconds:.0f} MB/s"
