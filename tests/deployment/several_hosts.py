"""The demo enterprise on several hosts and PostgreSQL, run for real: `make compose-test-hosts COMPOSE=...`.

A worker's host and the gateway's are killed, the database is restarted: every motor is diagnosed after each.
"""

import secrets
import sys
from collections import Counter

from service.demo.addresses import free_ports
from testing.service.processes import MOTOR_NAMES
from tests.deployment.composing import Compose
from tests.deployment.enterprise import ends_where_make_demo_ends
from tests.deployment.observed import START_LIMIT_S, Enterprise
from tests.deployment.steps import build, run_steps

LAID_OVER = "examples/several-hosts.yml"
WORKERS = ("worker-1", "worker-2")
GATEWAY = "gateway-1"


def every_host_starts(enterprise: Enterprise) -> None:
    enterprise.compose("up", "-d")
    enterprise.wait("the service is ready", lambda: enterprise.service.is_ready(), START_LIMIT_S)
    enterprise.log_in()


def hosts_share_the_work(enterprise: Enterprise) -> None:
    enterprise.wait("three hosts take jobs", lambda: len(_runners(enterprise)) == 3, START_LIMIT_S)
    enterprise.wait("two hosts visit relays", lambda: len(_gateways(enterprise)) == 2, START_LIMIT_S)
    _every_motor_is_diagnosed(enterprise)


def a_lost_worker_is_not_missed(enterprise: Enterprise) -> None:
    enterprise.compose("stop", "-t", "0", WORKERS[0])  # SIGKILL, which not every compose command can send
    _every_motor_is_diagnosed(enterprise)
    enterprise.wait("its lease has ended", lambda: len(_runners(enterprise)) == 2, START_LIMIT_S)
    enterprise.compose("start", WORKERS[0])
    enterprise.wait("it takes jobs again", lambda: len(_runners(enterprise)) == 3, START_LIMIT_S)


def the_relays_of_a_lost_gateway_are_taken_over(enterprise: Enterprise) -> None:
    enterprise.compose("stop", "-t", "0", GATEWAY)
    enterprise.wait("its lease has ended", lambda: len(_gateways(enterprise)) == 1, START_LIMIT_S)
    enterprise.wait_for_links()
    _every_motor_is_diagnosed(enterprise)
    enterprise.compose("start", GATEWAY)
    enterprise.wait("it visits relays again", lambda: len(_gateways(enterprise)) == 2, START_LIMIT_S)


def a_restarted_database_is_found_again(enterprise: Enterprise) -> None:
    enterprise.compose("restart", "database")
    enterprise.wait_for_links()
    _every_motor_is_diagnosed(enterprise)
    enterprise.wait("three hosts take jobs", lambda: len(_runners(enterprise)) == 3, START_LIMIT_S)
    enterprise.wait("two hosts visit relays", lambda: len(_gateways(enterprise)) == 2, START_LIMIT_S)


def nothing_came_twice(enterprise: Enterprise) -> None:
    recordings = enterprise.service.items("/recordings")
    times = Counter((str(row["motor"]), str(row["recorded_time"])) for row in recordings)
    assert max(times.values()) == 1, times
    for row in recordings:
        assert enterprise.service.get(f"/recordings/{row['id']}")["state"] == "diagnosed", row


def everything_is_taken_down(enterprise: Enterprise) -> None:
    enterprise.compose("down", "-v")
    assert not enterprise.compose.containers()


def _every_motor_is_diagnosed(enterprise: Enterprise) -> None:
    enterprise.trigger(*MOTOR_NAMES)


def _runners(enterprise: Enterprise) -> list[object]:
    return [row["host"] for row in enterprise.service.items("/job-runners")]


def _gateways(enterprise: Enterprise) -> list[object]:
    """Those that hold relays."""
    return [row["id"] for row in enterprise.service.items("/gateways") if row["relays"]]


STEPS = (
    build,
    every_host_starts,
    ends_where_make_demo_ends,
    hosts_share_the_work,
    a_lost_worker_is_not_missed,
    the_relays_of_a_lost_gateway_are_taken_over,
    a_restarted_database_is_found_again,
    nothing_came_twice,
    everything_is_taken_down,
)


def main(command: str) -> int:
    """Run every step. Returns 0, or 1 after the first that failed."""
    (port,) = free_ports(1)
    compose = Compose(command, port, laid_over=(LAID_OVER,), MCC_DATABASE_PASSWORD=secrets.token_hex(24))
    return run_steps(compose, STEPS)


if __name__ == "__main__":
    sys.exit(main(" ".join(sys.argv[1:])))
