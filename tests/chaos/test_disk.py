"""Where nothing can be mounted, processes that write are refused it all the same, and allowed it again."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.chaos.disk import WritingLimit

WRITER = """
import sys
for line in sys.stdin:
    try:
        with open(sys.argv[1], "ab") as file:
            file.write(b"x")
        print("written", flush=True)
    except OSError as error:
        print(error.strerror, flush=True)
"""


@pytest.mark.timeout(60)
def test_a_limit_stands_in_for_a_full_disk(tmp_path: Path) -> None:
    command = [sys.executable, "-c", WRITER, str(tmp_path / "file")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as writer:
        assert writer.stdin is not None
        assert writer.stdout is not None
        disk = WritingLimit(lambda: [writer.pid])
        answers = []
        for change in (disk.free, disk.fill, disk.fill, disk.free):
            change()
            writer.stdin.write("go\n")
            writer.stdin.flush()
            answers.append(writer.stdout.readline().strip())
        writer.stdin.close()
    assert answers == ["written", "File too large", "File too large", "written"]
