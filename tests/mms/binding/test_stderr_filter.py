"""What a process that speaks TLS leaves on standard error."""

import subprocess
import sys
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from mms.binding.stderr_filter import without_tls_log
from testing.relays.pki import Pki
from testing.relays.serving import RelayProcess

SCRIPT = """
import os, sys
from pathlib import Path
from mms import Client, TlsConfiguration
from mms.binding.stderr_filter import filter_tls_log_from_stderr
filter_tls_log_from_stderr()
folder = Path(sys.argv[2])
names = ("client.pem", "client.key", "relay.pem", "authority.pem")
certificate, key, pinned, ca = (folder / name for name in names)
tls = TlsConfiguration(certificate, key, (pinned,), ca)
Client.connect("127.0.0.1", int(sys.argv[1]), tls=tls).close()
print("from Python", file=sys.stderr)
os.write(2, b"from C\\n")
"""


def test_the_librarys_notes_are_left_out_and_everything_else_is_kept(tmp_path: Path) -> None:
    pki = Pki.make(tmp_path)
    relay = RelayProcess(tmp_path, pki.folder)
    try:
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, str(relay.port), str(tmp_path)],
            capture_output=True, text=True, timeout=60, check=True,
        )  # fmt: skip
    finally:
        relay.end()
    assert sorted(done.stderr.splitlines()) == ["from C", "from Python"]


def test_a_note_ends_where_another_line_begins() -> None:
    lines = [b"first\n", b"TLS: cert\n", b"  serial\n", b"\n", b"next\n", b"  indented\n", b"\n", b"TLS: x\n"]
    assert list(without_tls_log(iter(lines))) == [b"first\n", b"next\n", b"  indented\n", b"\n"]


@given(st.lists(st.binary(max_size=20).map(lambda text: b"log " + text.replace(b"\n", b"") + b"\n")))
def test_lines_of_a_log_all_pass(lines: list[bytes]) -> None:
    assert list(without_tls_log(iter(lines))) == lines
