"""The service's side of its gateways to other systems: they are kept running, and what they say is kept."""

import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from threading import Lock

import structlog

from service.configuration.settings import Settings
from service.supervision.supervised_process import SupervisedProcess

log = structlog.get_logger(__name__)

COMMAND = (sys.executable, "-m", "service.gateways")
"""With the gateway's kind behind it."""

LIBRARIES: Mapping[str, str] = {"modbus": "pymodbus", "mqtt": "aiomqtt", "opcua": "asyncua"}
"""The library that a gateway needs besides those of the service; the extra has the name of its kind."""

STARTING = "it starts"
LONGEST_PROBLEM = 500


@dataclass(frozen=True, slots=True)
class PlantGatewayStatus:
    """A gateway to other systems.

    restarts: how often it ended since the service started.  problem: what does not work in it; None while
    all does.
    """

    kind: str
    process_id: int | None
    restarts: int
    problem: str | None


def missing_library(settings: Settings) -> str | None:
    """Return which library a gateway of the settings lacks, and how to have it; None where none does."""
    for kind in settings.gateways.configured:
        library = LIBRARIES.get(kind)
        if library is not None and find_spec(library) is None:
            return (
                f"gateways.{kind}: expected the library {library}, found none: "
                f'pip install "statorwatch[{kind}]"'
            )
    return None


class PlantGateways:
    """Starts and stops the gateways that the settings name."""

    def __init__(self, settings: Settings, command: tuple[str, ...] = COMMAND) -> None:
        self._lock = Lock()
        self._problems: dict[str, str | None] = {}
        self._ends: Counter[str] = Counter()
        self._supervised = {
            kind: SupervisedProcess(
                f"the gateway {kind}",
                (*command, kind),
                settings,
                on_exit=partial(self._forget, kind),
                on_line=partial(self._hear, kind),
            )
            for kind in settings.gateways.configured
        }

    def start(self) -> None:
        """Start all gateways, and the threads that keep them running."""
        for supervised in self._supervised.values():
            supervised.start()

    def stop(self) -> None:
        """Ask all gateways to end, then wait for each."""
        for supervised in self._supervised.values():
            supervised.ask_to_end()
        for supervised in self._supervised.values():
            supervised.stop()

    def problem(self) -> str | None:
        """Return which gateways do not run. What a running one does not reach is not told here."""
        failing = [found for one in self._supervised.values() if (found := one.problem()) is not None]
        return "; ".join(failing) or None

    def status(self) -> Sequence[PlantGatewayStatus]:
        """Return how each gateway is."""
        with self._lock:
            told, ends = dict(self._problems), dict(self._ends)
        return [
            PlantGatewayStatus(
                kind, one.process_id, ends.get(kind, 0), one.problem() or told.get(kind, STARTING)
            )
            for kind, one in self._supervised.items()
        ]

    def _forget(self, kind: str, _exit_code: int | None) -> None:
        with self._lock:
            self._problems.pop(kind, None)
            self._ends[kind] += 1

    def _hear(self, kind: str, line: bytes) -> None:
        """Keep what a gateway says of itself."""
        said = json.loads(line)["problem"]
        problem = None if said is None else str(said)[:LONGEST_PROBLEM]
        if problem is not None:
            log.warning("a gateway to other systems", kind=kind, problem=problem)
        with self._lock:
            self._problems[kind] = problem
