"""The demo enterprise, run for real: `make compose-test COMPOSE="docker compose"`.

Builds and starts every container, triggers every motor over REST from outside, cuts a factory off while one
of its relays records (for 20 s, and for so long that records are lost), restarts what a person might, tries
what may be wrong on a host, backs up, restores, shows it a database of another version, takes all down.
"""

import shlex
import socket
import sys
import tarfile
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml

from service.demo.addresses import free_ports
from testing.service.processes import MOTOR_NAMES
from tests.deployment.composing import ROOT, Compose
from tests.deployment.documented import blocks
from tests.deployment.image import health_check
from tests.deployment.long_outage import (
    a_link_down_for_long_costs_what_the_relay_discards,
    an_upload_of_what_is_known_changes_nothing,
)
from tests.deployment.observed import START_LIMIT_S, Enterprise
from tests.deployment.steps import build, run_steps, say

SERVICES = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))["services"]
OUTAGE_S = 20.0
LARGEST_IMAGE_MB = 750
PUBLIC_BASE_MB = 130
"""The base image's size where another stands in for it."""

RECORD_TWICE = """
import sys, time, scl
from mms import Client
address = scl.read("/plant/plant.scd").seen_from(sys.argv[2]).address(sys.argv[1])
control = f"{sys.argv[1]}CON/RBGGIO1.SPCSO01"
with Client.connect(address.host, address.port) as relay:
    for _ in range(2):
        relay.operate(control, True)
        relay.operate(control, False)
        time.sleep(3)
"""
"""Somebody on a network presses the relay's button; the second record is of another second."""

REACH = """
import socket, sys
try:
    socket.create_connection((sys.argv[1], 102), 3).close()
    print("reached")
except OSError as error:
    print("out of reach:", error)
"""

OTHER_TABLES = """
import sqlite3, sys
database = sqlite3.connect("/data/statorwatch.sqlite")
database.execute("UPDATE alembic_version SET version_num = ?", sys.argv[1:])
database.commit()
"""
"""Has the volume say that another version made its tables."""

REVISION = """
import sqlite3
database = sqlite3.connect("/data/statorwatch.sqlite")
print("revision", *database.execute("SELECT version_num FROM alembic_version").fetchone())
"""


def every_container_starts_without_rights(enterprise: Enterprise) -> None:
    assert not enterprise.compose.containers()
    enterprise.compose("up", "-d")
    assert len(enterprise.compose.containers()) == len(SERVICES)
    enterprise.wait("the service is ready", lambda: enterprise.service.is_ready(), START_LIMIT_S)
    enterprise.log_in()
    question = "grep -E '^(Uid|Cap|NoNewPrivs)' /proc/1/status; touch /here 2>&1; df -m /tmp"
    for service in SERVICES:
        answer = enterprise.compose.inside(service, "sh", "-c", question)
        assert "Uid:" + 4 * "\t10001" in answer, f"{service}: {answer}"
        for capabilities in ("Inh", "Prm", "Eff", "Bnd", "Amb"):
            assert f"Cap{capabilities}:\t0000000000000000" in answer, f"{service}: {answer}"
        assert "NoNewPrivs:\t1" in answer, f"{service}: {answer}"
        assert "Read-only file system" in answer, f"{service}: {answer}"
        memory_mb = 256 if service == "mcc" else 64
        assert [memory_mb] == [
            int(line.split()[1]) for line in answer.splitlines() if line.endswith("% /tmp")
        ]


def the_image_is_small(enterprise: Enterprise) -> None:
    question = 'du -sxm /opt/statorwatch; du -sxm / 2>/dev/null; echo "public base:$PYTHON_SHA256"'
    answer = enterprise.compose.inside("mcc", "sh", "-c", question).splitlines()
    own_mb, whole_mb = (
        next(int(line.split()[0]) for line in answer if line.endswith(f"\t{directory}"))
        for directory in ("/opt/statorwatch", "/")
    )
    say(f"  the image: {whole_mb} MB, its own part of that: {own_mb} MB")
    if "public base:" in answer:
        whole_mb = own_mb + PUBLIC_BASE_MB
        say(f"  that is on a stand-in for the base image; on the public one's {PUBLIC_BASE_MB} MB:")
        say(f"  {whole_mb} MB, reckoned and not measured")
    assert whole_mb < LARGEST_IMAGE_MB, f"{whole_mb} MB"


def ends_where_make_demo_ends(enterprise: Enterprise) -> None:
    enterprise.wait_for_links()

    def all_diagnosed() -> bool:
        return all(enterprise.trend(motor) for motor in MOTOR_NAMES)

    def table_shown() -> bool:
        shown = enterprise.compose("logs", "demo").partition("Diagnoses and truth")[2]
        return all(motor in shown for motor in MOTOR_NAMES)

    enterprise.wait("every motor has a point in its trend", all_diagnosed, START_LIMIT_S)
    enterprise.wait("the demo's table of what was found beside the truth", table_shown, START_LIMIT_S)
    enterprise.require_right_verdicts()
    enterprise.compose("stop", "demo")


def health_checks_tell_well_from_ill(enterprise: Enterprise) -> None:
    checks = {name: SERVICES[name]["healthcheck"]["test"] for name in ("router-a", "relay-a1")}
    checks["mcc"] = shlex.join(health_check())
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
    enterprise.compose.inside("relay-a2", "python", "-c", RECORD_TWICE, relay, "FACTORY_A")
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
    enterprise.require_continuation(before)


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


def a_taken_port_is_named_and_the_rest_works(enterprise: Enterprise) -> None:
    motor, relay = "PUMP-A1", "A1_SEL710"
    before, points = enterprise.recordings(), enterprise.trend(motor)
    enterprise.compose("stop", "mcc")
    with socket.create_server(("127.0.0.1", enterprise.compose.port)):
        _require_port_named(enterprise, enterprise.compose.attempt("start", "mcc").stdout)
        # Another host of the wide-area network, through the router of factory A.
        enterprise.compose.inside("router-b", "python", "-c", RECORD_TWICE, relay, "WAN")
    enterprise.compose("start", "mcc")
    enterprise.wait_for_links()
    enterprise.wait("both points", lambda: len(enterprise.trend(motor)) == len(points) + 2, START_LIMIT_S)
    enterprise.require_continuation(before)


def _require_port_named(enterprise: Enterprise, refused: str) -> None:
    port = str(enterprise.compose.port)
    assert any(port in line and "already in use" in line for line in refused.splitlines()), refused
    assert not enterprise.service.is_ready()


def a_volume_that_cannot_be_written_to_is_named(enterprise: Enterprise) -> None:
    wrong = ("-e", "MCC_DATA_DIRECTORY=/plant")
    refused = enterprise.compose.attempt("run", "--rm", "-T", "--no-deps", *wrong, "mcc", "mcc", "serve")
    assert "mcc: /plant: expected a directory that user 10001 may write to" in refused.stdout, refused.stdout
    relay = ("ied-sim", "--scd", "/plant/plant.scd", "--files", "/plant", "--ied", "A1_SEL710")
    refused = enterprise.compose.attempt("run", "--rm", "-T", "--no-deps", "relay-a1", *relay)
    assert "ied-sim: [Errno 30] Read-only file system: '/plant/" in refused.stdout, refused.stdout
    assert enterprise.service.is_ready(), "the service that runs is disturbed"


def restarts_lose_nothing(enterprise: Enterprise) -> None:
    before = enterprise.recordings()
    enterprise.compose("restart", "relay-b2", "mcc")
    enterprise.wait_for_links()
    enterprise.trigger(*MOTOR_NAMES)
    enterprise.require_right_verdicts()
    enterprise.require_continuation(before)


def the_documented_backup_restores(enterprise: Enterprise) -> None:
    back_up, restore = blocks("Back-up and restore")
    before, points = enterprise.recordings(), {motor: enterprise.trend(motor) for motor in MOTOR_NAMES}
    waveforms = [enterprise.service.get(f"/recordings/{one}/waveform") for one in before]
    with TemporaryDirectory() as directory:
        started_s = time.monotonic()
        enterprise.compose.follow(back_up, directory)
        back_up_s = time.monotonic() - started_s
        archive = Path(directory, "backup.tar")
        with tarfile.open(archive) as members:
            assert "statorwatch.sqlite" in members.getnames()
        size_MB = archive.stat().st_size / 1e6
        say(f"  {len(before)} recordings, {size_MB:.1f} MB: backed up in {back_up_s:.1f} s")
        enterprise.keep_log()
        started_s = time.monotonic()
        enterprise.compose.follow(restore, directory)
        enterprise.wait("the service is ready", lambda: enterprise.service.is_ready(), START_LIMIT_S)
        enterprise.log_in()  # the volume of the token was emptied too
        enterprise.wait_for_links()
        say(f"  restored in {time.monotonic() - started_s:.1f} s, with taking down and starting all")
    enterprise.require_continuation(before)
    assert waveforms == [enterprise.service.get(f"/recordings/{one}/waveform") for one in before]
    for motor, old in points.items():
        assert enterprise.trend(motor)[: len(old)] == old


def a_database_of_another_version_is_refused(enterprise: Enterprise) -> None:
    before, points = enterprise.recordings(), {motor: enterprise.trend(motor) for motor in MOTOR_NAMES}
    ours = _revision(enterprise.compose.inside("mcc", "python", "-c", REVISION))
    enterprise.compose("stop", "mcc")
    enterprise.compose.once("mcc", "python", "-c", OTHER_TABLES, "0058")
    refused = enterprise.compose.attempt("run", "--rm", "-T", "--no-deps", "mcc", "mcc", "serve")
    assert refused.returncode != 0
    assert f"expected tables of revision {ours}, found 0058: another version made them" in refused.stdout
    assert _revision(enterprise.compose.once("mcc", "python", "-c", REVISION)) == "0058"
    enterprise.compose.once("mcc", "python", "-c", OTHER_TABLES, ours)
    enterprise.compose("start", "mcc")
    enterprise.wait("the service is ready", lambda: enterprise.service.is_ready(), START_LIMIT_S)
    enterprise.wait_for_links()
    enterprise.require_continuation(before)
    for motor, old in points.items():
        assert enterprise.trend(motor)[: len(old)] == old


def _revision(printed: str) -> str:
    (revision,) = (line.split()[1] for line in printed.splitlines() if line.startswith("revision "))
    return revision


def stopped_and_started_again_it_goes_on(enterprise: Enterprise) -> None:
    before, points = enterprise.recordings(), {motor: enterprise.trend(motor) for motor in MOTOR_NAMES}
    enterprise.down()
    with socket.create_server(("127.0.0.1", enterprise.compose.port)):
        _require_port_named(enterprise, enterprise.compose.attempt("up", "-d").stdout)
        others = [name for name in SERVICES if name.startswith(("relay", "router"))]
        running = [
            name for name in others if enterprise.compose.attempt("exec", "-T", name, "true").returncode == 0
        ]
        say(f"  with the port taken, up started {len(running)} of {len(others)} relays and routers")
    enterprise.compose("up", "-d")
    enterprise.wait_for_links()

    def all_go_on() -> bool:
        return all(len(enterprise.trend(motor)) > len(points[motor]) for motor in MOTOR_NAMES)

    enterprise.wait("one more point in every trend", all_go_on, START_LIMIT_S)
    enterprise.require_continuation(before)
    for motor, old in points.items():
        assert enterprise.trend(motor)[: len(old)] == old


def everything_is_taken_down(enterprise: Enterprise) -> None:
    enterprise.down("-v")
    assert not enterprise.service.is_ready()


STEPS = (
    build,
    every_container_starts_without_rights,
    the_image_is_small,
    ends_where_make_demo_ends,
    health_checks_tell_well_from_ill,
    relays_are_reached_through_the_router_alone,
    every_motor_is_triggered_from_outside,
    records_made_during_an_outage_arrive,
    a_link_down_for_long_costs_what_the_relay_discards,
    an_upload_of_what_is_known_changes_nothing,
    an_unreachable_relay_is_named_and_the_rest_works,
    a_taken_port_is_named_and_the_rest_works,
    a_volume_that_cannot_be_written_to_is_named,
    restarts_lose_nothing,
    the_documented_backup_restores,
    a_database_of_another_version_is_refused,
    stopped_and_started_again_it_goes_on,
    everything_is_taken_down,
)


def main(command: str) -> int:
    """Run every step. Returns 0, or 1 after the first that failed."""
    (port,) = free_ports(1)
    return run_steps(Compose(command, port), STEPS)


if __name__ == "__main__":
    sys.exit(main(" ".join(sys.argv[1:])))
