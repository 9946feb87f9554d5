"""A run against containers in steps, each of which says how long it took; nothing is left of it."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from service.client.rest_client import ServiceClient, ServiceError
from tests.deployment.composing import BUILD_LIMIT_S, ROOT, Compose, ComposeError
from tests.deployment.observed import Enterprise

SOURCE = """
import hashlib, importlib.util, pathlib
digest = hashlib.sha256()
for package in ("core", "ied_sim", "mms", "scl", "service"):
    directory = pathlib.Path(importlib.util.find_spec(package).origin).parent
    for path in sorted(directory.rglob("*.py")):
        digest.update(path.read_bytes())
print("source", digest.hexdigest())
"""


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201


def build(enterprise: Enterprise) -> None:
    """Make the image, and see that it is of this checkout."""
    enterprise.compose("build", limit_s=BUILD_LIMIT_S)
    here = subprocess.run(
        [sys.executable, "-c", SOURCE], cwd=ROOT, capture_output=True, text=True, check=True
    )
    # Some tools end with 0 when a build failed, and an older image would do for all that follows.
    there = enterprise.compose.once("mcc", "python", "-c", SOURCE)
    assert here.stdout.strip() in there.splitlines(), f"the image is not of this source: {there}"


def run_steps(compose: Compose, steps: Sequence[Callable[[Enterprise], None]]) -> int:
    """Run every step. Returns 0, or 1 after the first that failed."""
    started_s = time.monotonic()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("terminated: taking everything down"))
    with _taken_down(compose), ServiceClient(f"http://127.0.0.1:{compose.port}") as service:
        enterprise = Enterprise(compose, service)
        for step in steps:
            step_s = time.monotonic()
            try:
                step(enterprise)
            except (AssertionError, ComposeError, ServiceError) as error:
                say(compose.attempt("logs", "--tail", "40").stdout)
                say(f"FAILED {step.__name__.replace('_', ' ')}: {error}")
                return 1
            say(f"{time.monotonic() - step_s:6.1f} s  {step.__name__.replace('_', ' ')}")
    say(f"{time.monotonic() - started_s:6.1f} s  in all")
    say(f"{len(steps)} passed, 0 failed")
    return 0


@contextmanager
def _taken_down(compose: Compose) -> Iterator[None]:
    """Nothing of an earlier run before the block, nothing of this one after it."""
    compose.attempt("down", "-v")
    try:
        yield
    finally:
        compose.attempt("down", "-v")
