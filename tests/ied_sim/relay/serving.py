"""A relay on a free port of the loopback interface, and a client of it."""

import queue
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import scl
from ied_sim.relay.event_recorder import RecorderSettings
from ied_sim.relay.plant_clock import REAL_TIME, ClockSettings, PlantClock
from ied_sim.relay.relay import Relay
from ied_sim.scenario.scenario import healthy_reference
from mms import MOST_CONNECTIONS, Client, Report, ServerPump, ServerStartFailed, Value
from scl import Address
from testing.ports import LOOPBACK, free_port

IED = "A1_SEL710"
TRIGGER_BIT = f"{IED}CON/RBGGIO1.SPCSO01"
EVENT_REPORTS = f"{IED}CFG/LLN0.BR.BRep01"
PATIENCE_S = 60.0
SHORT_RECORD = RecorderSettings(sample_rate_hz=5_000.0, pre_trigger_s=0.02, post_trigger_s=0.06, capacity=3)


@dataclass(frozen=True, slots=True)
class ServedRelay:
    """A running relay and a client of it that takes its event reports."""

    relay: Relay
    client: Client
    reports: queue.SimpleQueue[Report]

    def pulse(self) -> None:
        """Operate RB01 true and false."""
        self.client.operate(TRIGGER_BIT, value=True)
        self.client.operate(TRIGGER_BIT, value=False)

    def next_value(self, name: str) -> Value:
        """Reported value of a data object of DSet01, the next that comes."""
        return next(values[name] for values in self._reported() if name in values)

    def next_record(self) -> int:
        """Number of the next record announced.

        The relay publishes the number first. It may be in an earlier report than RcdMade: a block that still
        buffers an earlier change of RcdMade sends that, with the number, before it takes the new one.
        """
        number: Value | None = None
        for values in self._reported():
            number = values.get("FltNum", number)
            if values.get("RcdMade") is True:
                break
        assert isinstance(number, int)
        return number

    def _reported(self) -> Iterator[dict[str, Value]]:
        """Values of each report by name of the data object; AssertionError when none comes."""
        while True:
            try:
                report = self.reports.get(timeout=PATIENCE_S)
            except queue.Empty:
                raise AssertionError(f"no report in {PATIENCE_S:g} s") from None
            yield {
                re.split(r"[.$]", member.reference or "")[-1]: member.value[0]
                for member in report.members
                if isinstance(member.value, tuple)
            }

    def names(self) -> list[str]:
        """Names in the EVENTS directory."""
        return sorted(entry.name.rpartition("/")[2] for entry in self.client.files("EVENTS"))


@contextmanager
def served_relay(
    files: Path, settings: RecorderSettings = SHORT_RECORD, clock: ClockSettings = REAL_TIME
) -> Iterator[ServedRelay]:
    """A1_SEL710 of the demo plant with the reference motor and, unless told otherwise, short records."""
    relay, pump = _start(files, settings, clock)
    try:
        with Client.connect(LOOPBACK, relay.server.port) as client:
            reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
            client.subscribe(EVENT_REPORTS, reports)
            yield ServedRelay(relay, client, reports)
    finally:
        relay.stop()
        pump.stop()


def _start(files: Path, settings: RecorderSettings, clock: ClockSettings) -> tuple[Relay, ServerPump]:
    """On a free port; another one where somebody was faster."""
    document = scl.read(scl.DEMO_PLANT_SCD)
    scenario = healthy_reference(IED)
    without_front = scenario.profile.model_copy(update={"sessions": MOST_CONNECTIONS})
    scenario = replace(scenario, profile=without_front, recorder=settings)
    for _ in range(5):
        relay = Relay(
            document,
            IED,
            scenario,
            address=Address(LOOPBACK, free_port()),
            files=files,
            clock=PlantClock(time.time_ns(), clock),
        )
        pump = ServerPump([relay.server])
        try:
            pump.start()
        except ServerStartFailed:
            continue
        return relay, pump
    raise AssertionError("no free port")
