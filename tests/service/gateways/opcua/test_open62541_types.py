"""A client of another stack, with the published node sets, knows our types and finds the machines by them."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from testing.service.gateways import running_gateways
from tests.service.gateways.opcua.clients import PEER, address_of, require_open62541
from tests.service.gateways.settings import settings_of

PARTS = {
    "Identification": "MachineIdentificationType",
    "Monitoring": "MonitoringType",
    "Notifications": "NotificationsType",
}
NODES = 97
"""Of the two companion specifications."""


@pytest.mark.usefixtures("repository")
def test_open62541_knows_each_node_of_the_companion_specifications(tmp_path: Path) -> None:
    require_open62541()
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    script = Path(__file__).with_name("open62541_types.py")
    with running_gateways(chosen):
        peer = subprocess.run(
            [sys.executable, str(script), str(PEER), address_of(chosen)],
            capture_output=True,
            text=True,
            timeout=100,
            check=False,
        )
    assert peer.returncode == 0, peer.stdout[-2000:] + peer.stderr[-2000:]
    seen = json.loads(peer.stdout.splitlines()[-1])
    assert seen["others"] == []
    assert seen["compared"] == NODES
    assert seen["machines"] == {"FAN-A2": PARTS, "PUMP-A1": PARTS}
