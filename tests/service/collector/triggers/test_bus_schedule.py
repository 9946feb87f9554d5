"""A bus is recorded at once: every relay on it is triggered within a minute, over real MMS."""

import os
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from threading import Event, Thread

from core.units import NANOSECONDS_PER_SECOND
from service.background.scheduling import Scheduler
from service.collector.gateway.gateway import Gateway, GatewayIdentity
from service.plant import Bus, Plant, PlantMotor, Schedule, Site
from service.storage.records import RecordingRequest
from service.storage.states import LinkState, RecordingRequestState
from testing.ports import free_port
from testing.service.plants import motor
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

MINUTE_NS = 60 * NANOSECONDS_PER_SECOND
RELAYS = (NAME, "A2_SEL710", "A3_SEL710")
"""They are of one model, so that references of the first serve for all."""


def plant_on_a_bus(bench: Bench) -> Plant:
    relays = tuple(replace(bench.relay, name=name, port=free_port()) for name in RELAYS)
    motors = tuple(PlantMotor(motor(f"M-{relay.name}"), "", "FACTORY_A", relay.name) for relay in relays)
    bus = Bus("MCC-A", tuple(one.name for one in motors), Schedule.parse("* * * * *"))
    return Plant(
        (Site("FACTORY_A", ""),), relays, tuple(replace(one, bus=bus.name) for one in motors), (bus,)
    )


def test_all_relays_of_a_bus_make_their_records_at_once(bench: Bench, tmp_path: Path) -> None:
    plant, repository = plant_on_a_bus(bench), bench.repository
    repository.sync_plant(plant)
    made = Gateway(
        GatewayIdentity("a", "here", os.getpid()), plant, repository, bench.store, bench.settings,
        on_expiry=lambda: None,
    )  # fmt: skip
    due_ns = time.time_ns() // MINUTE_NS * MINUTE_NS
    scheduler = Scheduler(plant.motors, repository, buses=plant.buses, since_ns=due_ns - 1)
    stop = Event()
    thread = Thread(target=made.run, args=(stop,))

    def asked() -> list[RecordingRequest]:
        return list(repository.recording_requests(limit=10).items)

    with ExitStack() as stack:
        for relay in plant.relays:
            stack.callback(ScriptedRelay(tmp_path / relay.name, relay.port).stop)
        thread.start()
        stack.callback(thread.join, 15)
        stack.callback(stop.set)
        assert eventually(lambda: all(repository.relay(name).link_state is LinkState.UP for name in RELAYS))
        scheduler.request_due(due_ns)
        assert {one.motor for one in asked()} == {one.name for one in plant.motors}
        assert eventually(lambda: all(one.state is RecordingRequestState.FETCHED for one in asked()))
    triggered = [one.triggered_ns for one in asked() if one.triggered_ns is not None]
    assert len(triggered) == len(RELAYS)
    assert max(triggered) - min(triggered) < 10 * NANOSECONDS_PER_SECOND
