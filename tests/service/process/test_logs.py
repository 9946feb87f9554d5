import json
import os
import pty
import re
import subprocess
import sys

import pytest

SCRIPT = """
from python_multipart.exceptions import MultipartParseError
from python_multipart.multipart import MultipartParser
from service.process.logs import configure_logging

configure_logging("test")
try:
    MultipartParser(b"x").write(b"nonsense")
except MultipartParseError:
    print("refused")
"""


def test_bad_uploads_do_not_fill_the_log() -> None:
    ended = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert (ended.stdout, ended.stderr) == ("refused\n", "")


EVENT = """
import sys
import structlog
from service.process.logs import configure_logging

configure_logging("service", sys.argv[1])
structlog.get_logger().info("serving", host="127.0.0.1", motors=6)
"""
TEXT = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\dZ \[info\] serving host=127.0.0.1 motors=6 process=service\r?\n"


@pytest.mark.parametrize(
    ("log_format", "terminal", "is_text"),
    [("auto", True, True), ("auto", False, False), ("text", False, True), ("json", True, False)],
)
def test_lines_are_readable_on_a_terminal_and_json_elsewhere(
    log_format: str, terminal: bool, is_text: bool
) -> None:
    reader, writer = pty.openpty() if terminal else os.pipe()
    environment = {**os.environ, "NO_COLOR": "1"}
    command = [sys.executable, "-c", EVENT, log_format]
    subprocess.run(command, stderr=writer, env=environment, check=True)
    line = os.read(reader, 1 << 16).decode()
    os.close(reader)
    os.close(writer)
    if is_text:
        assert re.fullmatch(TEXT, line), line
    else:
        told = json.loads(line)
        assert (told["event"], told["motors"], told["level"]) == ("serving", 6, "info")
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z", told["timestamp"])
