"""An MMS client that is not ours: the wheel's own. A program, because its C library may not share a process.

python foreign_client.py HOST PORT FILE: tells as JSON what a relay offers, and fetches a file of EVENTS.
"""

import json
import sys
import tempfile
from pathlib import Path

from pyiec61850 import pyiec61850 as swig
from pyiec61850.mms import MMSClient


def main(host: str, port: int, record: str) -> None:
    client = MMSClient()
    client.connect(host, port)
    devices = client.get_logical_devices()
    with tempfile.TemporaryDirectory() as directory:
        copy = Path(directory) / "copy"
        client.download_file(f"EVENTS/{record}", str(copy))
        size = copy.stat().st_size
    found = {
        "devices": devices,
        "nodes": {device: client.get_logical_nodes(device) for device in devices},
        "objects": client.get_data_objects("A1_SEL710PRO", "FLTRDRE1"),
        "events": events(client),
        "fetched_bytes": size,
    }
    client.disconnect()
    sys.stdout.write(json.dumps(found))


def events(client: MMSClient) -> list[str]:
    """Names in EVENTS. The wheel's client lists no files of its own accord, its connection does."""
    entries, error = swig.IedConnection_getFileDirectory(client._connection, "EVENTS")
    if error != swig.IED_ERROR_OK:
        raise SystemExit(f"listing EVENTS failed with error {error}")
    names = []
    entry = swig.LinkedList_getNext(entries)
    while entry:
        name = swig.FileDirectoryEntry_getFileName(swig.toFileDirectoryEntry(swig.LinkedList_getData(entry)))
        names.append(name)
        entry = swig.LinkedList_getNext(entry)
    return names


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3])
