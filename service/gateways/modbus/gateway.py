"""The Modbus gateway: follows the plant's state and puts it into registers."""

import asyncio
from collections.abc import Mapping
from pathlib import Path

import structlog

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.context import GatewayContext
from service.gateways.kept_file import write_table
from service.gateways.modbus.register_map import (
    BLOCK,
    FIRST_BLOCK,
    MOST_MOTORS,
    NOTHING_KNOWN,
    blocks,
    header,
)
from service.gateways.modbus.server import BoundedServer, Registers
from service.gateways.numbering import MotorNumbers
from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.following import NOT_READ, PlantFollower

log = structlog.get_logger(__name__)

NUMBERS = "modbus-numbers.json"
MAP = "modbus-map.csv"

ALIVE_S = 1.0
"""The counter in the header moves on so often: a client sees that the values are told by somebody."""


def run(context: GatewayContext) -> None:
    """Serve until the service is gone."""
    settings = context.settings.gateways.modbus
    assert settings is not None  # noqa: S101 - it was started for them
    asyncio.run(_serve(context, settings))


async def _serve(context: GatewayContext, settings: ModbusSettings) -> None:
    plant = PlantRegisters(context.settings.data_directory)
    server = BoundedServer(plant.registers.device(), settings)
    following = asyncio.create_task(_follow(context, plant))
    try:
        while not context.stop.is_set() and not following.done():
            # It answers before the first reading: a client tells bad values better than a closed port.
            is_listening = server.transport or await server.listen()
            plant.tick()
            await asyncio.sleep(ALIVE_S)
            port = f"{settings.bind_address}:{settings.port}"
            context.tell(plant.problem if is_listening else f"{port}: the port is not free")
        await following
    finally:
        await server.shutdown()  # type: ignore[no-untyped-call]


async def _follow(context: GatewayContext, plant: "PlantRegisters") -> None:
    """Put each change into the registers; the waiting is done by a thread."""
    follower: PlantFollower = context.follower()
    try:
        while not context.stop.is_set():
            change = await asyncio.to_thread(follower.next_change, context.stop, longest_s=ALIVE_S)
            plant.silence = follower.problem
            if change is not None:
                plant.put(change)
    finally:
        follower.close()


class PlantRegisters:
    """Registers of the whole plant, and which motor has which."""

    def __init__(self, data_directory: Path) -> None:
        """Raises KeptFileError."""
        self.registers = Registers()
        self.silence: str | None = NOT_READ
        self._numbers = MotorNumbers(data_directory / NUMBERS)
        self._map = data_directory / MAP
        self._state = PlantState()
        self._alive = 0
        self._too_many = 0
        self.tick()

    @property
    def problem(self) -> str | None:
        """Return what does not work; None while all does."""
        if self.silence is not None:
            return self.silence
        if self._too_many:
            return f"{self._too_many} motors have no registers: there is room for {MOST_MOTORS}"
        return None

    def put(self, change: PlantChange) -> None:
        """Tell a change of the plant's state."""
        numbers = self._numbers.of(change.now.motors)
        self._too_many = sum(numbers[motor] >= MOST_MOTORS for motor in change.now.motors)
        if change.before.motors.keys() != change.now.motors.keys():
            write_table(self._map, ("motor", "block", "first register"), _map_rows(numbers))
        self._state = change.now
        gone = {
            FIRST_BLOCK + BLOCK * numbers[motor]: NOTHING_KNOWN
            for motor in change.motors_gone
            if numbers[motor] < MOST_MOTORS
        }
        self.registers.put({**gone, **blocks(change.now, numbers)})
        self._put_header()

    def tick(self) -> None:
        """Move the counter on."""
        self._alive += 1
        self._put_header()

    def _put_header(self) -> None:
        count = min(1 + max(self._numbers.of(()).values(), default=-1), MOST_MOTORS)
        self.registers.put({0: header(self._state, blocks=count, alive=self._alive)})


def _map_rows(numbers: Mapping[str, int]) -> list[tuple[str, int, int]]:
    """Return which registers each motor has, by block."""
    by_block = sorted(numbers.items(), key=lambda one: one[1])
    return [(motor, number, FIRST_BLOCK + BLOCK * number) for motor, number in by_block]
