"""Commands: real programs, as those who are on call have them."""

import json
import sys
import time
from pathlib import Path

import pytest

from service.configuration.channels import CommandChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.sending import send
from testing.service.processes import is_alive
from testing.waiting import eventually


def channel(*command: str, timeout_s: float = 20) -> CommandChannel:
    return CommandChannel.model_validate({"kind": "command", "command": command, "timeout_s": timeout_s})


def python(script: str, *arguments: str, timeout_s: float = 20) -> CommandChannel:
    return channel(sys.executable, "-c", script, *arguments, timeout_s=timeout_s)


def test_a_program_gets_the_message_and_nothing_else(
    tmp_path: Path, message: Message, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MCC_NOTIFY_PASSWORD_OPS", "secret")
    kept = tmp_path / "kept $(touch x); `y`"
    script = (
        "import sys, os, json; given = json.load(sys.stdin); "
        "json.dump([sys.argv[1:], given, sorted(os.environ), os.getcwd()], open(sys.argv[1], 'w'))"
    )
    send("pager", python(script, str(kept)), "", message)
    arguments, given, variables, folder = json.loads(kept.read_text())
    assert arguments == [str(kept)], "no shell has read them"
    assert given == {**message.document, "text": message.text}
    assert set(variables) <= {"PATH", "LANG", "LC_CTYPE"}
    assert folder == "/"
    assert [path.name for path in tmp_path.iterdir()] == [kept.name]


def test_a_program_that_fails_says_why(message: Message) -> None:
    script = "import sys; sys.stderr.write('x' * 100_000 + '\\nno modem\\n'); sys.exit(3)"
    with pytest.raises(SendError, match=r"exit code 3: no modem$"):
        send("pager", python(script), "", message)
    with pytest.raises(
        SendError, match="/no/such/program: expected a program that can be run, found: No such"
    ):
        send("pager", channel("/no/such/program"), "", message)


def test_a_program_that_hangs_ends_with_all_that_it_started(tmp_path: Path, message: Message) -> None:
    script = (
        "import os, subprocess, sys, time; "
        "child = subprocess.Popen(['/bin/sleep', '600']); "
        "open(sys.argv[1], 'w').write(f'{os.getpid()} {child.pid}'); time.sleep(600)"
    )
    kept = tmp_path / "processes"
    with pytest.raises(SendError, match="no answer within 3 s"):
        send("pager", python(script, str(kept), timeout_s=3), "", message)
    processes = [int(word) for word in kept.read_text().split()]
    assert len(processes) == 2
    assert eventually(lambda: not any(is_alive(process) for process in processes))


def test_what_a_program_leaves_behind_does_not_hold_up_the_message(message: Message) -> None:
    script = "import os, time\nif os.fork() == 0:\n    time.sleep(600)"
    begun_s = time.monotonic()
    send("pager", python(script, timeout_s=60), "", message)
    assert time.monotonic() - begun_s < 50


def _open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def test_no_open_file_is_left(message: Message) -> None:
    send("pager", channel("/bin/true"), "", message)
    before = _open_files()
    for _ in range(3):
        send("pager", channel("/bin/true"), "", message)
        with pytest.raises(SendError):
            send("pager", channel("/bin/false"), "", message)
    assert _open_files() <= before
