"""Settings of a service with one gateway."""

from pathlib import Path

from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from testing.ports import free_port


def settings_of(kind: str, directory: Path, **table: object) -> Settings:
    """Settings whose table [gateways.<kind>] is this, on a free port unless it says another."""
    gateways = GatewaysSettings.model_validate({kind: {"port": free_port(), **table}})
    return Settings(data_directory=directory, stale_after_days=3650, gateways=gateways)


def port_of(settings: Settings) -> int:
    """The port of the only gateway."""
    (kind,) = settings.gateways.configured
    return int(getattr(settings.gateways, kind).port)
