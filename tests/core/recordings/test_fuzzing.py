"""The fuzzer itself: it reads mutants of every kind, and finds what a reader must not do."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FORBIDDEN = {
    "another exception": "raise KeyError(path)",
    "a warning": "import warnings; warnings.warn('careful')",
    "no end": "while True: pass",
    "memory": "return bytes(200 << 20)",
    "death": "import os; os._exit(9)",
    "silent repair": "import dataclasses; return dataclasses.replace(read(path), repairs=('mended',))",
}
SABOTAGED = """
import sys
import benchmarks.recordings.fuzzing as fuzz
from core.recordings import read

def bad(path, *, lenient=False):
    if not bad.armed:
        return read(path)
    {body}

class Armed(fuzz.Tally):
    def __init__(self):
        super().__init__()
        bad.armed = True

bad.armed, fuzz.read, fuzz.Tally = False, bad, Armed
fuzz.SECONDS_A_FILE = 0.05
if __name__ == "__main__":
    sys.argv = ["fuzz", "--seconds", "30", "--mutants", "500", "--seed", "1", "--keep", sys.argv[1]]
    sys.exit(fuzz.main())
"""


def run(*command: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[3])}
    return subprocess.run(
        [sys.executable, *command], capture_output=True, text=True, timeout=100, check=False, env=environment
    )


def test_a_thousand_mutants(tmp_path: Path) -> None:
    done = run(
        *("-m", "benchmarks.recordings.fuzzing", "--seconds", "60", "--mutants", "1000", "--seed", "4"),
        *("--keep", str(tmp_path / "kept")),
    )
    assert done.returncode == 0, done.stderr
    assert "1000 mutants" in done.stdout
    for kind in ("CEV", "COMTRADE 1991 ASCII", "COMTRADE 1999 BINARY", "COMTRADE CFF FLOAT32"):
        assert kind in done.stdout
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("body", FORBIDDEN.values(), ids=FORBIDDEN)
def test_what_a_reader_must_not_do_is_found(tmp_path: Path, body: str) -> None:
    script = tmp_path / "sabotaged.py"
    script.write_text(SABOTAGED.format(body=body), encoding="utf-8")
    done = run(str(script), str(tmp_path / "kept"))
    assert done.returncode == 1, done.stdout + done.stderr
    assert "its files are kept in" in done.stderr
    assert list((tmp_path / "kept").iterdir())
