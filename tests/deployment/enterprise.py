"""The demo enterprise, run for real: `make compose-test COMPOSE="docker compose"`.

Builds and starts every container, triggers every motor over REST from outside, cuts a factory off while one
of its relays records, restarts what a person might, tries what may be wrong on a host, takes all down.
"""

import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

import yaml

from service.demo.addresses import free_ports
from service.rest_client import ServiceClient, ServiceError
from tests.deployment.composing import BUILD_LIMIT_S, ROOT, Compose, ComposeError
from tests.integration.processes import MOTOR_NAMES, link_states

START_LIMIT_S = 120.0
DIAGNOSIS_LIMIT_S = 60.0
OUTAGE_S = 20.0
LARGEST_PART_MB = 550
"""Of the image, on its base image of about 130 MB."""

RECORD_TWICE = """
import sys, time, scl
from mms import Client
address = scl.read("/plant/plant.scd").address(sys.argv[1])
control = f"{sys.argv[1]}CON/RBGGIO1.SPCSO01"
with Client.connect(address.host, address.port) as relay:
    for _ in range(2):
        relay.operate(control, True)
        relay.operate(control, False)
        time.sleep(3)
"""
"""Somebody in the factory presses the button; the second record is of another second."""

REACH = """
import socket, sys
try:
    socket.create_connection((sys.argv[1], 102), 3).close()
    print("reached")
except OSError as error:
    print("out of reach:", error)
"""

SOURCE = """
import hashlib, importlib.util, pathlib
digest = hashlib.sha256()
for package in ("core", "ied_sim", "mms", "scl", "service"):
    directory = pathlib.Path(importlib.util.find_spec(package).origin).parent
    for path in sorted(directory.rglob("*.py")):
        digest.update(path.read_bytes())
print("source", digest.hexdigest())
"""

Recordings = Mapping[str, tuple[str, str]]
"""(motor, time of the recording) by identifier."""


class Enterprise:
    """The running containers, as somebody outside sees them."""

    def __init__(self, compose: Compose, service: ServiceClient) -> None:
        self.compose = compose
        self.service = service

    def wait(self, what: str, condition: Callable[[], bool], limit_s: float) -> None:
        """Until it is so; AssertionError when that takes too long."""
        deadline_s = time.monotonic() + limit_s
        while time.monotonic() < deadline_s:
            try:
                if condition():
                    return
            except ServiceError:
                pass  # it is being restarted
            time.sleep(0.5)
        raise AssertionError(f"not within {limit_s:g} s: {what}; links: {self.links()}")

    def links(self) -> Mapping[str, str]:
        return link_states(self.service)

    def wait_for_links(self) -> None:
        def all_up() -> bool:
            return self.service.is_ready() and set(self.links().values()) == {"up"}

        self.wait("the service is ready and every relay answers", all_up, START_LIMIT_S)

    def recordings(self, motor: str | None = None) -> Recordings:
        query = {} if motor is None else {"motor": motor}
        return {
            str(row["id"]): (str(row["motor"]), str(row["recorded_time"]))
            for row in self.service.items("/recordings", **query)
        }

    def trend(self, motor: str) -> list[str]:
        """Times of its points, as told: oldest first."""
        return [str(point["time"]) for point in self.service.items(f"/motors/{motor}/trend")]

    def trigger(self, *motors: str) -> None:
        """Over REST; each comes to one diagnosis of one more recording."""
        before = self.recordings()
        reports = {motor: str(self.service.request_event_report(motor)["id"]) for motor in motors}

        def ended() -> bool:
            states = {self.service.event_report(report)["state"] for report in reports.values()}
            assert "failed" not in states, [self.service.event_report(report) for report in reports.values()]
            return states == {"diagnosed"}

        self.wait(f"diagnoses of {', '.join(motors)}", ended, DIAGNOSIS_LIMIT_S)
        new = [motor for one, (motor, _) in self.recordings().items() if one not in before]
        assert sorted(new) == sorted(motors), f"one more recording each, found {new}"

    def require_right_verdicts(self) -> None:
        status = self.compose.document("mcc", "mcc", "demo-status", "--json")
        assert status["right"] == len(MOTOR_NAMES), status


def build(enterprise: Enterprise) -> None:
    enterprise.compose("build", limit_s=BUILD_LIMIT_S)
    here = subprocess.run(
        [sys.executable, "-c", SOURCE], cwd=ROOT, capture_output=True, text=True, check=True
    )
    # Some tools end with 0 when a build failed, and an older image would do for all that follows.
    there = enterprise.compose.once("mcc", "python", "-c", SOURCE)
    assert here.stdout.strip() in there.splitlines(), f"the image is not of this source: {there}"


def ends_where_make_demo_ends(enterprise: Enterprise) -> None:
    enterprise.compose("up", "-d")
    enterprise.wait_for_links()

    def all_diagnosed() -> bool:
        return all(enterprise.trend(motor) for motor in MOTOR_NAMES)

    enterprise.wait("every motor has a point in its trend", all_diagnosed, START_LIMIT_S)
    enterprise.require_right_verdicts()
    enterprise.compose("stop", "demo")


def containers_have_no_rights(enterprise: Enterprise) -> None:
    question = "id -u; grep CapBnd /proc/self/status; touch /here 2>&1; du -sxm /opt/statorwatch"
    for service in ("mcc", "router-a", "relay-a1"):
        answer = enterprise.compose.inside(service, "sh", "-c", question)
        assert "\n10001\n" in f"\n{answer}", answer
        assert "CapBnd:\t0000000000000000" in answer, answer
        assert "Read-only file system" in answer, answer
    size_mb = next(
        int(line.split()[0]) for line in answer.splitlines() if line.endswith("\t/opt/statorwatch")
    )
    assert size_mb < LARGEST_PART_MB, f"{size_mb} MB"
    say(f"  the image's own part: {size_mb} MB")


def health_checks_tell_well_from_ill(enterprise: Enterprise) -> None:
    composition = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))
    checks = {name: composition["services"][name]["healthcheck"]["test"] for name in ("router-a", "relay-a1")}
    for owner, check in checks.items():
        for service in checks:
            told = enterprise.compose.attempt("exec", "-T", service, "sh", "-c", f"({check}) && echo healthy")
            assert ("healthy" in told.stdout.splitlines()) == (owner == service), told.stdout


def relays_are_reached_through_the_router_alone(enterprise: Enterprise) -> None:
    address = "import socket; print('at', socket.gethostbyname(socket.gethostname()))"
    printed = enterprise.compose.inside("relay-a1", "python", "-c", address)
    relay = next(line.split()[1] for line in printed.splitlines() if line.startswith("at "))
    assert "reached" in enterprise.compose.inside("router-a", "python", "-c", REACH, relay).splitlines()
    assert "out of reach" in enterprise.compose.inside("mcc", "python", "-c", REACH, relay)


def every_motor_is_triggered_from_outside(enterprise: Enterprise) -> None:
    enterprise.trigger(*MOTOR_NAMES)
    enterprise.require_right_verdicts()


def records_made_during_an_outage_arrive(enterprise: Enterprise) -> None:
    motor, relay = "FAN-A2", "A2_SEL710"
    before, points = enterprise.recordings(), enterprise.trend(motor)
    enterprise.compose("stop", "router-a")
    stopped_s = time.monotonic()
    enterprise.compose.inside("relay-a2", "python", "-c", RECORD_TWICE, relay)
    enterprise.wait("its link is down", lambda: enterprise.links()[relay] == "down", OUTAGE_S)
    enterprise.trigger("COMPRESSOR-B2")
    time.sleep(max(0.0, stopped_s + OUTAGE_S - time.monotonic()))
    assert not [row for one, row in enterprise.recordings(motor).items() if one not in before]
    enterprise.compose("start", "router-a")
    enterprise.wait("both points", lambda: len(enterprise.trend(motor)) >= len(points) + 2, START_LIMIT_S)
    enterprise.wait_for_links()
    new = [
        row for row in enterprise.service.items("/recordings", motor=motor) if str(row["id"]) not in before
    ]
    assert len(new) == 2, f"each once, found {new}"
    as_recorded = sorted(new, key=lambda row: str(row["recorded_time"]))
    assert as_recorded == sorted(new, key=lambda row: str(row["fetched_time"])), f"in order, found {new}"
    assert enterprise.trend(motor) == points + [str(row["recorded_time"]) for row in as_recorded]


def an_unreachable_relay_is_named_and_the_rest_works(enterprise: Enterprise) -> None:
    enterprise.compose("stop", "relay-b3")

    def down() -> bool:
        link = enterprise.service.get("/ieds/B3_SEL710")
        return link["link_state"] == "down" and "router-b:10215" in str(link["link_reason"])

    enterprise.wait("the link to B3_SEL710 is down, with the address", down, START_LIMIT_S)
    enterprise.trigger("CONVEYOR-B1", "PUMP-A1")
    mcc, router = enterprise.compose("logs", "mcc"), enterprise.compose("logs", "router-b")
    assert any("link down" in line and "B3_SEL710" in line for line in mcc.splitlines()), mcc
    assert any("relay unreachable" in line and "relay-b3:102" in line for line in router.splitlines()), router
    enterprise.compose("start", "relay-b3")
    enterprise.wait_for_links()


def a_taken_port_is_named(enterprise: Enterprise) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        elsewhere = enterprise.compose.at_port(port)
        refused = elsewhere.attempt("run", "--rm", "-T", "--no-deps", "--service-ports", "mcc", "true")
    lines = refused.stdout.splitlines()
    assert any(str(port) in line and "already in use" in line for line in lines), refused.stdout
    assert enterprise.service.is_ready(), "the service that runs is disturbed"


def a_volume_that_cannot_be_written_to_is_named(enterprise: Enterprise) -> None:
    wrong = ("-e", "MCC_DATA_DIRECTORY=/plant")
    refused = enterprise.compose.attempt("run", "--rm", "-T", "--no-deps", *wrong, "mcc", "mcc", "serve")
    assert "mcc: /plant: expected a directory that user 10001 may write to" in refused.stdout, refused.stdout
    assert enterprise.service.is_ready(), "the service that runs is disturbed"


def restarts_lose_nothing(enterprise: Enterprise) -> None:
    before = enterprise.recordings()
    enterprise.compose("restart", "relay-b2", "mcc")
    enterprise.wait_for_links()
    enterprise.trigger(*MOTOR_NAMES)
    enterprise.require_right_verdicts()
    require_continuation(enterprise, before)


def stopped_and_started_again_it_goes_on(enterprise: Enterprise) -> None:
    before, points = enterprise.recordings(), {motor: enterprise.trend(motor) for motor in MOTOR_NAMES}
    enterprise.compose("down")
    enterprise.compose("up", "-d")
    enterprise.wait_for_links()

    def all_go_on() -> bool:
        return all(len(enterprise.trend(motor)) > len(points[motor]) for motor in MOTOR_NAMES)

    enterprise.wait("one more point in every trend", all_go_on, START_LIMIT_S)
    require_continuation(enterprise, before)
    for motor, old in points.items():
        assert enterprise.trend(motor)[: len(old)] == old


def require_continuation(enterprise: Enterprise, before: Recordings) -> None:
    """All earlier recordings are there, and none came twice."""
    now = enterprise.recordings()
    assert before.items() <= now.items()
    assert len(set(now.values())) == len(now), sorted(now.values())


STEPS = (
    build,
    ends_where_make_demo_ends,
    containers_have_no_rights,
    health_checks_tell_well_from_ill,
    relays_are_reached_through_the_router_alone,
    every_motor_is_triggered_from_outside,
    records_made_during_an_outage_arrive,
    an_unreachable_relay_is_named_and_the_rest_works,
    a_taken_port_is_named,
    a_volume_that_cannot_be_written_to_is_named,
    restarts_lose_nothing,
    stopped_and_started_again_it_goes_on,
)


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201


@contextmanager
def _taken_down(compose: Compose) -> Iterator[None]:
    """Nothing of an earlier run before the block, nothing of this one after it."""
    compose.attempt("down", "-v")
    try:
        yield
    finally:
        compose.attempt("down", "-v")


def main(command: str) -> int:
    """Run every step. Returns 0, or 1 after the first that failed."""
    (port,) = free_ports(1)
    compose = Compose(command, port)
    started_s = time.monotonic()
    with _taken_down(compose), ServiceClient(f"http://127.0.0.1:{port}") as service:
        enterprise = Enterprise(compose, service)
        for step in STEPS:
            step_s = time.monotonic()
            try:
                step(enterprise)
            except (AssertionError, ComposeError, ServiceError) as error:
                say(compose.attempt("logs", "--tail", "40").stdout)
                say(f"FAILED {step.__name__.replace('_', ' ')}: {error}")
                return 1
            say(f"{time.monotonic() - step_s:6.1f} s  {step.__name__.replace('_', ' ')}")
    say(f"{time.monotonic() - started_s:6.1f} s  in all")
    say(f"{len(STEPS)} passed, 0 failed")
    return 0


if __name__ == "__main__":
    sys.exit(main(" ".join(sys.argv[1:])))
