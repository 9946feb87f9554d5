"""What a gateway stands on."""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event

from service.configuration.settings import Settings
from service.gateways.plant_state.following import PlantFollower
from service.storage.repository import Repository


@dataclass(frozen=True, slots=True)
class GatewayContext:
    """stop: set when the gateway is to end. tell: says what does not work at present, None for nothing."""

    settings: Settings
    repository: Repository
    stop: Event
    tell: Callable[[str | None], None]

    def follower(self) -> PlantFollower:
        """Return one that follows the plant's state for this gateway, on a connection of its own."""
        return PlantFollower(self.repository, stale_after_days=self.settings.stale_after_days)
