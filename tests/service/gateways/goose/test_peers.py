"""On the wire with what is not ours: open61850 publishes, and tshark decodes what our relay does."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from testing.not_installed import not_installed
from tests.mms.goose.network_namespace import IN_NAMESPACE, require_network_namespace
from tests.service.gateways.goose.peers import TOGGLES


def found(what: str, directory: Path) -> dict[str, Any]:
    """What a program finds in a network of its own."""
    require_network_namespace()
    command = [*IN_NAMESPACE, sys.executable, "-m", "tests.service.gateways.goose.peers", what]
    done = subprocess.run([*command, str(directory)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-4000:]
    read: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return read


def test_a_peers_trip_under_a_priority_tag_is_an_alarm_whoever_forges_and_whoever_toggles(
    tmp_path: Path,
) -> None:
    told = found("published", tmp_path)
    # MaxTime is 1 s, so a state lives for 4 s at most; the forged one promises ten minutes.
    assert 4.0 < told["told after the forged state [s]"] < 30.0
    # 21 changes are written at once, then one a second; half of them are rises.
    assert 0 < told["raised"] <= (21 + told["toggled for [s]"]) / 2 + 1 < TOGGLES / 2
    block = "A1_SEL710CFG/LLN0$GO$GPub01"
    (named,) = told["named meanwhile"]
    assert named.endswith(
        "1 of 6 GOOSE control blocks are told in two states at once, and one of them is ignored as a "
        f"replay: {block}"
    )
    assert told["the peer's trip"] == ["PUMP-A1"]
    assert told["it toggles"] == (
        f"1 of 6 GOOSE control blocks change too often, and not all of it is written: {block}"
    )


def test_tshark_decodes_the_simulated_relays_trip_and_its_priority_tag(tmp_path: Path) -> None:
    if shutil.which("tshark") is None:
        not_installed("no tshark: apt-get install --no-install-recommends tshark")
    told = found("captured", tmp_path)
    good = ",".join(["0000"] * 9)
    block = "A1_SEL710CFG/LLN0$GO$GPub01"
    assert told["before"] == ["4", "0", block, "1", "0", ",".join("0" * 9), good]
    priority, vlan, reference, state, sequence, values, qualities = told["trip"]
    assert (priority, vlan, reference, sequence, qualities) == ("4", "0", block, "0", good)
    assert int(state) > 1
    assert values[0] == "1"
