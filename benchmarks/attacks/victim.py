"""A service to attack: `mcc serve` of any source tree, in bounds that keep the machine alive."""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.attacks.attack import Target
from benchmarks.attacks.observation import cpu_s
from service.demo.addresses import free_ports
from testing.service.accounts import log_in_before_start
from testing.service.processes import service_environment, switched_off_plant

ADDRESS_SPACE_BYTES = 8 << 30
"""Of each process of the service: beyond it an attack meets a MemoryError, and the machine lives on."""

START_LIMIT_S = 240.0
"""A tree that was never used compiles its machine models first."""

QUIET_LIMIT_S = 90.0
QUIET_SHARE = 0.15
"""A service that uses less than this share of a core is at rest."""


@contextmanager
def victim(source: Path, **settings: str) -> Iterator[tuple[int, Target]]:
    """The process id and address of a service of the tree at `source`, on empty data."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-attack-") as name:
        directory = Path(name)
        (port,) = free_ports(1)
        settings = {
            "MCC_SCD": str(switched_off_plant(directory)),
            "MCC_PORT": str(port),
            "PYTHONPATH": str(source),
            **settings,
        }
        environment = service_environment(directory / "data", settings)
        token = log_in_before_start(environment, f"http://127.0.0.1:{port}")
        with (
            (directory / "log").open("wb") as log,
            subprocess.Popen(
                [sys.executable, "-m", "service.cli", "serve"],
                cwd=source,
                env=environment,
                stdout=log,
                stderr=log,
                preexec_fn=_bound,
            ) as process,
        ):
            target = Target("127.0.0.1", port, directory / "data" / "statorwatch.sqlite", token)
            try:
                _wait_until_ready(process, target, directory / "log")
                yield process.pid, target
            finally:
                process.kill()


def settle(process_id: int) -> None:
    """Wait until the service is at rest, or for QUIET_LIMIT_S."""
    deadline = time.monotonic() + QUIET_LIMIT_S
    while time.monotonic() < deadline:
        before = cpu_s(process_id)
        time.sleep(1.0)
        if cpu_s(process_id) - before < QUIET_SHARE:
            return


def _bound() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE_BYTES, ADDRESS_SPACE_BYTES))


def _wait_until_ready(process: "subprocess.Popen[bytes]", target: Target, log: Path) -> None:
    deadline = time.monotonic() + START_LIMIT_S
    while target.ask("GET", "/readyz") != "200":
        if process.poll() is not None or time.monotonic() > deadline:
            raise RuntimeError(log.read_text(encoding="utf-8"))
        time.sleep(0.1)
