"""Memory of a service by its processes: python -m benchmarks.collector.memory [--workers 2] [--records 3].

The demo's six relays are simulated; each motor is recorded so often, and all records are diagnosed before.
What processes share is divided by their number (proportional set size).
"""

import argparse
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from service.client.rest_client import ServiceClient
from testing.service.processes import (
    FORKED,
    MOTOR_NAMES,
    Service,
    all_recordings,
    descendants,
    running_service,
    simulated_plant,
    workers_of,
)
from testing.waiting import wait_until

KINDS = {b"service.collector": "collector", b"service.cli": "service", FORKED: "parent of the workers"}
LONGEST_S = 300.0


def measure(workers: int, records: int) -> Iterator[str]:
    """One line for each kind of process, and one for all of them."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-memory-") as name:
        directory = Path(name)
        with (
            simulated_plant(directory) as plant,
            running_service(directory, plant.scd, MCC_WORKERS=str(workers)) as service,
            ServiceClient(service.url) as client,
        ):
            for number in range(1, records + 1):
                for motor in MOTOR_NAMES:
                    client.request_recording(motor)
                expected = number * len(MOTOR_NAMES)
                wait_until(partial(_has_diagnosed, client, expected), "diagnoses", LONGEST_S)
            yield from _by_kind(service)
            yield f"simulated relays beside it: {_proportional_MB(plant.process.pid):.0f} MB"


def _has_diagnosed(client: ServiceClient, number: int) -> bool:
    return sum(one["state"] == "diagnosed" for one in all_recordings(client)) >= number


def _by_kind(service: Service) -> Iterator[str]:
    workers = set(workers_of(service.process_id))
    found: dict[str, list[float]] = defaultdict(list)
    for process_id in (service.process_id, *descendants(service.process_id)):
        command = Path(f"/proc/{process_id}/cmdline").read_bytes()
        kind = next((name for word, name in KINDS.items() if word in command), "others")
        found["worker" if process_id in workers else kind].append(_proportional_MB(process_id))
    for kind, sizes in sorted(found.items()):
        yield f"{kind}: {' + '.join(f'{one:.0f}' for one in sizes)} MB"
    yield f"together: {sum(map(sum, found.values())):.0f} MB"


def _proportional_MB(process_id: int) -> float:
    lines = Path(f"/proc/{process_id}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024.0


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.collector.memory", description=__doc__)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--records", type=int, default=3)
    arguments = parser.parse_args()
    for line in measure(arguments.workers, arguments.records):
        print(line, flush=True)


if __name__ == "__main__":
    main()
