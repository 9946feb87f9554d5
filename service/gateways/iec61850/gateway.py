"""The IEC 61850 gateway: follows the plant's state and offers it as the data of an IED."""

from importlib.metadata import version
from pathlib import Path
from typing import Final

import structlog

import scl
from mms import (
    CredentialFileError,
    Identity,
    Server,
    ServerStartFailed,
    TlsConfiguration,
    filter_tls_log_from_stderr,
    read_secret,
)
from scl.model_text import model_text
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.gateways.context import GatewayContext
from service.gateways.iec61850.description import TEMPLATE, description
from service.gateways.iec61850.logical_devices import PLANT, logical_devices
from service.gateways.iec61850.values import meanings, motor_values, names, plant_values
from service.gateways.kept_file import replace_file
from service.gateways.plant_state.figures import PlantChange, PlantState

log = structlog.get_logger(__name__)

VERSION: Final = version("statorwatch")

INSTANCE = "statorwatch.iid"
"""File in the data directory: describes this IED, by its name."""

CAPABILITIES = "statorwatch.icd"
"""The same without a name, for tools that give one."""

ASSOCIATION_S = 5.0
"""A client that has not associated within this time is sent away: there is room for few."""

LOOK_S = 1.0
"""Longest wait for a change before it is seen whether the service is gone."""


def run(context: GatewayContext) -> None:
    """Serve until the service is gone."""
    settings = context.settings.gateways.iec61850
    assert settings is not None  # noqa: S101 - it was started for them
    if settings.tls is not None:
        filter_tls_log_from_stderr()
    follower = context.follower()
    ied = PlantIed(settings, context.settings.data_directory)
    try:
        while not context.stop.is_set():
            change = follower.next_change(context.stop, longest_s=LOOK_S)
            if change is not None or not ied.is_running:
                ied.tell(change)
            context.tell(ied.problem or follower.problem)
    finally:
        ied.stop()
        follower.close()


class PlantIed:
    """The service as an IED. Its data model is that of the motors in service; others make it begin anew."""

    def __init__(self, settings: Iec61850Settings, data_directory: Path) -> None:
        self._settings = settings
        self._instance = data_directory / INSTANCE
        self._capabilities = data_directory / CAPABILITIES
        self._server: Server | None = None
        self._state = PlantState()
        self._devices: dict[str, str] = {}
        self.problem: str | None = None

    @property
    def is_running(self) -> bool:
        """Whether clients are served."""
        return self._server is not None

    def tell(self, change: PlantChange | None) -> None:
        """Offer a change; None tries again to begin."""
        if change is not None:
            self._state = change.now
        if self._state.read_ns == 0:
            return  # nothing is known of the plant yet, not even its motors
        if change is not None and self._devices.keys() == change.now.motors.keys() and self.is_running:
            self._update(change)
        else:
            self._begin()

    def stop(self) -> None:
        """End every connection."""
        server, self._server = self._server, None
        if server is not None:
            server.stop()

    def _begin(self) -> None:
        self.stop()
        self._devices = dict(logical_devices(self._state.motors))
        try:
            server = self._built()
        except CredentialFileError as error:
            self.problem = str(error)
            return
        for motor, device in self._devices.items():
            server.update_many(meanings(self._path(device)))
            self._tell_motor(server, motor, self._state)
        plant = self._path(PLANT)
        server.update_many(names(plant, "The plant", "StatorWatch", "service", VERSION))
        server.update_many(plant_values(plant, self._state))
        try:
            server.start()
        except ServerStartFailed as error:
            server.stop()
            self.problem = str(error)
            return
        self._server, self.problem = server, None
        log.info("serving IEC 61850", port=self._settings.port, logical_devices=1 + len(self._devices))

    def _update(self, change: PlantChange) -> None:
        assert self._server is not None  # noqa: S101 - asked before
        relays = {relay.name for relay in change.relays}
        told = {motor.name for motor in change.motors}
        for name, motor in change.now.motors.items():
            if name in told or motor.relay in relays:
                self._tell_motor(self._server, name, change.now)
        values = plant_values(self._path(PLANT), change.now, change.before)
        self._server.update_many(values, whole_objects=True)

    def _tell_motor(self, server: Server, name: str, state: PlantState) -> None:
        """Set the values of a motor, and the names of its relay: it may have another one by now."""
        motor, path = state.motors[name], self._path(self._devices[name])
        relay = state.relays.get(motor.relay)
        vendor, model = ("", "") if relay is None else (relay.manufacturer, relay.type)
        server.update_many(names(path, name, vendor, model, VERSION))
        server.update_many(motor_values(path, motor, relay), whole_objects=True)

    def _built(self) -> Server:
        """Write the descriptions, and make a server of that of the instance."""
        settings = self._settings
        texts = {device: motor for motor, device in self._devices.items()}
        shown = {"password": settings.password_file is not None, "certificate": settings.tls is not None}
        for file, name in ((self._capabilities, TEMPLATE), (self._instance, settings.ied_name)):
            replace_file(file, description(name, texts, plant=PLANT, revision=VERSION, shown=shown))
        tls: TlsConfiguration | None = None if settings.tls is None else settings.tls.configuration()
        passwords = [] if settings.password_file is None else [_password(settings.password_file)]
        return Server(
            model_text(scl.read(self._instance), settings.ied_name),
            address=str(settings.bind_address),
            port=settings.port,
            max_connections=settings.max_connections,
            report_buffer_bytes=settings.report_buffer_bytes,
            tls=tls,
            passwords=passwords,
            association_timeout_s=ASSOCIATION_S,
            identity=Identity("StatorWatch", "Motor health", VERSION),
        )

    def _path(self, device: str) -> str:
        return f"{self._settings.ied_name}{device}"


def _password(file: Path) -> str:
    return read_secret(file).decode("latin-1").removesuffix("\n").removesuffix("\r")
