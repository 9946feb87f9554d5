"""A broker that is not ours, and what the gateway tells it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.configuration.settings import Settings
from testing.service.mosquitto import Mosquitto, running_mosquitto
from tests.service.gateways import settings


def settings_of(directory: Path, port: int, **table: object) -> Settings:
    """Settings of a service whose gateway tells a broker on this port."""
    return settings.settings_of("mqtt", directory, port=port, **{"timeout_s": 3.0, "keepalive_s": 5, **table})


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Mosquitto]:
    """One that anybody on loopback may use."""
    with running_mosquitto(tmp_path) as broker:
        yield broker
