"""A client of open62541 (the package o6), in a process of its own: it has a package `examples`, as we do.

Arguments: the folder of the package, address, certificate, key, user; the password on the standard input.
Prints one JSON document with what it saw.
"""

import json
import sys
from datetime import datetime
from typing import Any

folder, address, certificate, key, user = sys.argv[1:6]
sys.path.insert(0, folder)

import o6  # noqa: E402 - found in that folder only

OURS = 2


def node(path: str) -> Any:
    """The node of a path in the plant's namespace."""
    return o6.NodeId(f"ns={OURS};s={path}")


def told(client: Any, path: str) -> list[object]:
    """Status and source time of a value, as good as it may be."""
    found = client.read(node(path), valueOnly=False)
    return [int(found.status), str(found.sourceTimestamp)]


def main() -> None:
    """Look at PUMP-A1, at its history, and have it recorded."""
    client = o6.Client(
        address,
        certificate=certificate,
        privateKey=key,
        securityMode=o6.SecurityMode.SIGN_AND_ENCRYPT,
        securityPolicy=o6.SecurityPolicy.BASIC256SHA256,
        applicationUri="urn:statorwatch:test-client",
        username=user,
        password=sys.stdin.readline().strip(),
    )
    client.connect(createDefaultSubscription=False)
    try:
        level = node("motor/PUMP-A1/FaultLevel")
        history = client.historyRead(level, datetime(2025, 1, 1), datetime(2035, 1, 1))
        seen = {
            "state": client.read(node("motor/PUMP-A1/State")),
            "level": client.read(node("motor/PUMP-A1/FaultLevel")),
            "health": int(client.read(node("motor/PUMP-A1/DeviceHealth"))),
            "told": {motor: told(client, f"motor/{motor}/FaultLevel") for motor in ("PUMP-A1", "FAN-A2")},
            "history": [one.value for one in history.dataValues],
            "request": str(client.call(node("service"), node("service/TriggerRecording"), ["PUMP-A1"])),
        }
    finally:
        client.disconnect()
    sys.stdout.write("\n" + json.dumps(seen, default=str) + "\n")


main()
