"""Gateways to other systems as the service runs them: real processes on a real database."""

from collections.abc import Iterator
from contextlib import contextmanager

from service.configuration.settings import Settings
from service.gateways.supervision import PlantGateways
from testing.waiting import wait_until


@contextmanager
def started_gateways(settings: Settings) -> Iterator[PlantGateways]:
    """Run the gateways of these settings, whether they work or not."""
    gateways = PlantGateways(settings)
    gateways.start()
    try:
        yield gateways
    finally:
        gateways.stop()


@contextmanager
def running_gateways(settings: Settings) -> Iterator[PlantGateways]:
    """Run the gateways of these settings; the block begins when nothing lacks in any of them."""
    with started_gateways(settings) as gateways:
        wait_until(lambda: all(one.problem is None for one in gateways.status()), "the gateways to work")
        yield gateways
