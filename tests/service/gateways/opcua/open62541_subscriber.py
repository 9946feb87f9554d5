"""A client of open62541 (the package o6) that is told of changes and events, in a process of its own.

Arguments: the folder of the package, address, certificate, key, user. The first line of the standard input is
the password; the client ends when the input does. Prints a line of JSON for each thing that it is told.
"""

import json
import sys
from collections.abc import Callable
from typing import Any

folder, address, certificate, key, user = sys.argv[1:6]
sys.path.insert(0, folder)

import o6  # noqa: E402 - found in that folder only

OURS = 2
PUMP = "motor/PUMP-A1"
EVENT = "SELECT /EventId, /SourceName, /SourceNode, /Time, /Message, /Severity"


def say(what: str, told: object) -> None:
    """Tell the test; the library writes lines of its own."""
    sys.stdout.write("\n" + json.dumps({"what": what, "told": told}, default=str) + "\n")
    sys.stdout.flush()


def node(path: str) -> Any:
    """The node of a path in the plant's namespace."""
    return o6.NodeId(f"ns={OURS};s={path}")


def telling(what: str) -> Callable[[Any], None]:
    """What tells value, status and source time of a variable."""

    def tell(told: Any) -> None:
        value = told.value
        shown = value if isinstance(value, str) else int(value)
        say(what, [shown, int(told.status), str(told.sourceTimestamp)])

    return tell


def event(told: Any) -> None:
    """Tell of an event."""
    say("event", {path.removeprefix("/"): str(value) for path, value in told.items()})


def main() -> None:
    """Subscribe to state and health of PUMP-A1, and to its events."""
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
        subscription = client.createSubscription(publishingInterval=100.0)
        for name in ("State", "DeviceHealth"):
            variable = node(f"{PUMP}/{name}")
            client.monitor(variable, telling(name), valueOnly=False, subscription=subscription)
        client.monitorEvent(node(f"{PUMP}/Notifications"), event, EVENT, subscription=subscription)
        say("ready", None)
        sys.stdin.read()
    finally:
        client.disconnect()


main()
