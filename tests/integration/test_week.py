"""A week of a plant in minutes: what people are told of a fault that grows, and of a site that is lost.

Real processes: the service, and simulated relays whose time runs faster. A real mail server counts the mails.
"""

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from email.message import EmailMessage
from pathlib import Path

import pytest

import scl
from scl import Address
from service.cli.app import main
from service.client.rest_client import Document, ServiceClient, segment
from service.demo import MONTH, MONTH_MOTORS, SCENARIO
from service.demo.addresses import free_ports
from service.demo.month import Month, month_of
from testing.service.processes import RELAYS, running_service
from testing.service.receivers import Mailbox, mail_server
from testing.waiting import eventually

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(900)]

DAYS, LEAP_H, LEAP_S = 7, 2, 4.0
FAN, FAN_RELAY = "FAN-A2", "A2_SEL710"
FACTORY_A = tuple(relay for relay in RELAYS if relay.startswith("A"))
FACTORY_B = tuple(relay for relay in RELAYS if relay.startswith("B"))
MOTORS_A = ("PUMP-A1", FAN, "MILL-A3")

FAULT = ((3.0, 0.0), (7.0, 1.0))
"""Days, and the share of a coil's turns that are shorted."""

MOST_ROUNDS = 150
"""On a machine that is busy the week may be over before the fault is seen to grow; it stays as it is then."""

AFTER_LEAP_S = 0.3
"""A round begins so long after a leap of the plant's clock, which other processes show a little later."""

ALARMS = {"forecast_days": 0, "link_down_s": 600, "link_up_s": 2, "site_lost_s": 10}


def week(directory: Path) -> Path:
    """The demo's month as a week, in which nothing is wrong but the fan."""
    text = MONTH.read_text()
    speed_up = LEAP_H * 3600 / LEAP_S + 1
    for pattern, new in (
        (r"start_days_ago = \S+", f"start_days_ago = {DAYS}"),
        (r"speed_up = \S+", f"speed_up = {speed_up:g}"),
        (r"leap_every_s = \S+", f"leap_every_s = {LEAP_S:g}"),
        (r"\[motor\.cage\]\nbars = 28\ntimeline = \[.*\]\n", ""),
        (r"timeline = \[.*\]", f"timeline = [{', '.join(_step(*step) for step in FAULT)}]"),
        (r"swing_period_s = 230000", "swing_period_s = 53000"),
        (r"changes = \[.*\]\n", ""),
        (r'\[motor\.fault\]\nphase = "a"\ncoil = 2\ncoil_share = \S+\n', ""),
        (r"stop = \{.*\}\n", ""),
    ):
        text, number = re.subn(pattern, new, text)
        assert number, pattern
    scenario = directory / "week.toml"
    scenario.write_text(text)
    return scenario


def _step(days: float, coil_share: float) -> str:
    return f"{{ at_days = {days}, coil_share = {coil_share} }}"


@contextmanager
def factory(scd: Path, relays: Sequence[str], scenario: Path, files: Path) -> Iterator[str]:
    """The relays of a factory, as a process; yields what it printed before it was ready."""
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(scenario)]
    command += ["--files", str(files), *(word for relay in relays for word in ("--ied", relay))]
    with (
        (files.parent / f"{relays[0]}.log").open("w") as log,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True) as process,
    ):
        try:
            assert process.stdout is not None
            printed = []
            for line in process.stdout:
                printed.append(line)
                if line.strip() == "ready":
                    break
            yield "".join(printed)
        finally:
            process.terminate()
            process.wait(20)


@dataclass
class Week:
    """The plant while its week passes, and what people were told."""

    client: ServiceClient
    url: str
    month: Month
    mailbox: Mailbox
    leap: int = 0
    rounds: int = 0

    def told(self) -> list[str]:
        """Who got which mail, in the order of the mails."""
        return [f"{_receiver(mail)}: {str(mail['Subject']).strip()}" for mail in self.mailbox.mails]

    def live_until(self, told: int) -> None:
        """Have the motors recorded after each leap of the plant's clock until so many mails have come."""

        def enough() -> bool:
            return len(self.mailbox.mails) >= told

        while not enough():
            self.leap = max(self.leap, self.month.leap_at(datetime.now(UTC))) + 1
            self.rounds += 1
            assert self.rounds < MOST_ROUNDS, self.told()
            eventually(enough, max(0.0, self.month.until_leap_s(self.leap, datetime.now(UTC)) + AFTER_LEAP_S))
            if not enough():
                asked = [str(self.client.request_recording(motor)["id"]) for motor in MOTORS_A]
                assert self._has_ended(asked)

    def _has_ended(self, requests: Sequence[str]) -> bool:
        ended = ("diagnosed", "failed")
        return eventually(
            lambda: all(self.client.get_event_report(one)["state"] in ended for one in requests), 60
        )

    def open_alarms(self) -> dict[str, Document]:
        """The alarms that are not over, by their kinds."""
        return {str(alarm["kind"]): alarm for alarm in self.client.items("/alarms/open")}

    def acknowledge(self, alarm: Document, comment: str) -> None:
        """Do what the page on alarms says."""
        words = ["alarms", "acknowledge", str(alarm["id"])[:8], "--comment", comment, "--url", self.url]
        assert main(words) == 0


def _receiver(mail: EmailMessage) -> str:
    return str(mail["To"]).partition("@")[0]


@contextmanager
def living_week(directory: Path) -> Iterator[tuple[Week, Callable[[], None], Callable[[], None]]]:
    """The plant with its service and a mail server; and what stops and starts factory B."""
    ports = free_ports(len(RELAYS))
    scd = directory / "plant.scd"
    addresses = {relay: Address("127.0.0.1", port) for relay, port in zip(RELAYS, ports, strict=True)}
    scl.with_addresses(scl.DEMO_PLANT_SCD, scd, addresses)
    scenario = week(directory)
    with ExitStack() as running, ExitStack() as factory_b:

        def start_b() -> None:
            factory_b.enter_context(factory(scd, FACTORY_B, SCENARIO, directory / "b"))

        mailbox = running.enter_context(mail_server())
        settings = {
            "MCC_MOTORS": str(MONTH_MOTORS),
            "MCC_STALE_AFTER_DAYS": "60",
            "MCC_ALARMS": json.dumps(ALARMS),
            "MCC_NOTIFICATIONS": json.dumps(notifications(mailbox.port)),
        }
        start_b()
        printed = running.enter_context(factory(scd, FACTORY_A, scenario, directory / "a"))
        month = month_of(scenario, printed)
        assert month is not None
        service = running.enter_context(running_service(directory, scd, **settings))
        client = running.enter_context(ServiceClient(service.url))
        yield Week(client, service.url, month, mailbox), factory_b.close, start_b


def notifications(port: int) -> Mapping[str, object]:
    """The shift is told of everything that matters; the manager of a fault that nobody acknowledges."""
    address = {"host": "127.0.0.1", "port": port, "security": "none"}
    server = {"kind": "mail", **address, "from": "mcc@plant.example"}
    return {
        "gather_s": 1,
        "pause_s": 0,
        "channels": {name: {**server, "to": [f"{name}@plant.example"]} for name in ("shift", "manager")},
        "routes": [
            {"channels": ["shift"], "priorities": ["high", "medium"]},
            {
                "channels": ["shift"],
                "priorities": ["critical"],
                "escalations": [{"after_min": 0.2, "channels": ["manager"]}],
            },
            {"channels": ["shift"], "kinds": ["site-lost"], "events": ["cleared"]},
        ],
    }


WEEK = (
    rf"shift: \[medium\] {FAN}: condition watch: .*",
    rf"shift: \[critical\] {FAN}: condition fault: shorted turns.*",
    rf"manager: \[critical\] Not acknowledged: {FAN}: condition fault: shorted turns.*",
    rf"shift: \[critical\] {FAN}: condition fault, worse than before: shorted turns.*",
    r"shift: \[high\] FACTORY_B: site lost",
    r"shift: FACTORY_B: site lost is over",
)


def test_people_are_told_once_of_each_thing_that_they_have_to_know(tmp_path: Path) -> None:
    with living_week(tmp_path) as (plant, stop_b, start_b):
        plant.live_until(told=1)
        assert plant.open_alarms().keys() == {"condition-watch"}
        plant.live_until(told=3)
        alarm = plant.open_alarms()["condition-fault"]
        assert alarm["motor"] == FAN
        assert "condition-watch" not in plant.open_alarms(), "the fault takes its place"
        plant.acknowledge(alarm, "the winding is tested at the next stop")
        plant.live_until(told=4)
        again = plant.open_alarms()["condition-fault"]
        assert (again["id"], again["state"]) == (alarm["id"], "unacknowledged"), "it has grown"
        plant.acknowledge(again, "the stop comes sooner")
        stop_b()
        assert eventually(lambda: len(plant.told()) >= 5, 180), plant.told()
        start_b()
        assert eventually(lambda: len(plant.told()) >= 6, 180), plant.told()
        states = {kind: alarm["state"] for kind, alarm in plant.open_alarms().items()}
        assert states == {"condition-fault": "acknowledged", "site-lost": "returned-unacknowledged"}
        sent = [str(message["state"]) for message in plant.client.items("/notifications")]
        changes = plant.client.items(f"/alarms/{segment(str(alarm['id']))}/changes")
        history = [str(change["event"]) for change in changes][::-1]
    told = plant.told()
    assert len(told) == len(WEEK), told
    assert [line for line, expected in zip(told, WEEK, strict=True) if not re.fullmatch(expected, line)] == []
    assert [state for state in sent if state != "withdrawn"] == ["sent"] * len(WEEK)
    assert [event for event in history if event != "raised"] == ["acknowledged", "reopened", "acknowledged"]
