"""A record pulled twice is seen, whatever the database makes of it."""

import pytest

from tests.deployment.transfers import require_once_each, transfers

STORED = '{"relay": "A1", "record": "C_0001", "size_bytes": 9, "recording": "one", "event": "record stored"}'
AGAIN = STORED.replace("record stored", "record known already")
OTHER = STORED.replace("C_0001", "C_0002").replace('"one"', '"two"')
AROUND = "podman logs mcc\nmcc-1  | {} of it\n" + '{"event": "connected", "relay": "A1"}\n'


def test_each_once() -> None:
    found = transfers(f"{AROUND}mcc-1  | {STORED}\n{OTHER}\nexit code: 0\n")
    assert [(transfer.record, transfer.recording) for transfer in found] == [
        ("C_0001", "one"),
        ("C_0002", "two"),
    ]
    require_once_each(found, ["one", "two"])


@pytest.mark.parametrize("second", [AGAIN, STORED])
def test_a_second_time(second: str) -> None:
    with pytest.raises(AssertionError, match="pulled"):
        require_once_each(transfers(f"{STORED}\n{OTHER}\n{second}"), ["one", "two"])


def test_a_recording_nobody_pulled() -> None:
    with pytest.raises(AssertionError, match="'two': 0"):
        require_once_each(transfers(STORED), ["one", "two"])
