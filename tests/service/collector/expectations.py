"""A bench whose relay is what an SCL says, wherever it answers and whatever it really is."""

from dataclasses import replace

from scl.ied_model import Ied
from service.plant.metering import measurands_from_scl
from service.plant.offer import offer_from_scl
from service.plant.overrides import AS_RECOGNISED, Overrides
from service.plant.recognition import recognise
from testing.relays.simulated import Simulated
from tests.service.collector.conftest import Bench


def expecting(bench: Bench, ied: Ied, overrides: Overrides = AS_RECOGNISED) -> Bench:
    """The bench with what this SCL promises of its relay."""
    points = recognise(ied)
    relay = replace(
        bench.relay,
        trigger_control=points.trigger,
        record_made=points.record_made,
        fault_number=points.record_number,
        report_control=points.report_control,
        metering_data_set=points.metering_data_set,
        measurands=measurands_from_scl(ied),
        expected=offer_from_scl(ied),
        overrides=overrides,
    )
    return replace(bench, relay=relay)


def at(bench: Bench, served: Simulated) -> Bench:
    """The bench with the simulated relay in its relay's place, and time for its records."""
    relay = replace(bench.relay, host=served.address.host, port=served.address.port)
    settings = bench.settings.model_copy(update={"record_timeout_s": 15.0, "request_timeout_s": 5.0})
    return replace(bench, relay=relay, settings=settings)


def overriding(bench: Bench, overrides: Overrides) -> Bench:
    """The bench with what the motors file decides about its relay."""
    return replace(bench, relay=replace(bench.relay, overrides=overrides))
