import subprocess
import sys

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
