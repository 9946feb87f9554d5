"""A client of open62541 (the package o6) that is told of changes, in a process of its own.

Arguments: the folder of the package, address, certificate, key, user. The first line of the standard input is
the password; the client ends when the input does. Prints a line of JSON for each thing that it is told.
"""

import json
import sys
from typing import Any

folder, address, certificate, key, user = sys.argv[1:6]
sys.path.insert(0, folder)

import o6  # noqa: E402 - found in that folder only

OURS = 2


def say(what: str, told: object) -> None:
    """Tell the test; the library writes lines of its own."""
    sys.stdout.write("\n" + json.dumps({"what": what, "told": told}, default=str) + "\n")
    sys.stdout.flush()


def state(value: Any) -> None:
    """Tell of the motor's state."""
    say("State", value)


def health(value: Any) -> None:
    """Tell of the motor's health."""
    say("DeviceHealth", int(value))


def main() -> None:
    """Subscribe to state and health of PUMP-A1."""
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
        for name, told in (("State", state), ("DeviceHealth", health)):
            variable = o6.NodeId(f"ns={OURS};s=motor/PUMP-A1/{name}")
            client.monitor(variable, told, subscription=subscription)
        say("ready", None)
        sys.stdin.read()
    finally:
        client.disconnect()


main()
