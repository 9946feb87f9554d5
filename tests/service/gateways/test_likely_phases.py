"""Where the phase of shorted turns is not sure, every gateway tells the likely ones."""

import math
import struct
from dataclasses import replace

import pytest

from core.condition.kinds import Kind
from service.gateways.iec104.points import LIKELY_PHASES, said_of
from service.gateways.iec61850.values import motor_values
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK, blocks
from service.gateways.mqtt import documents
from service.gateways.mqtt.sparkplug.metrics import of_motor
from service.gateways.opcua.values import MOTOR_VARIABLES, motor_value
from service.gateways.plant_state.figures import MotorFigures, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.storage import Repository
from testing.service.conditions import FAULT, OPEN_PHASE, tell
from testing.service.plants import NOW_NS

PUMP = "PUMP-A1"
LIKELY = (0.72, 0.0, 0.28)


def told_by_all(motor: MotorFigures, state: PlantState) -> list[object]:
    """What OPC UA, Sparkplug and plain MQTT tell of the likely phases."""
    (variable,) = [one for one in MOTOR_VARIABLES if one.name == "LikelyPhases"]
    (metric,) = [one for one in of_motor(motor, state) if one.name == "Condition/Likely Phases"]
    plain = documents.figures(motor).partition(b'"phase_probabilities": ')[2].partition(b', "mu_f"')[0]
    return [motor_value(variable, motor, state).Value.Value, metric.value, plain.decode()]


def numbers_of_all(motor: MotorFigures, state: PlantState) -> list[list[float]]:
    """The probabilities as Modbus, IEC 104 and IEC 61850 tell them."""
    registers = blocks(state, {name: number for number, name in enumerate(state.motors)})
    block = registers[FIRST_BLOCK + BLOCK * [*state.motors].index(motor.name)]
    modbus = struct.unpack(">3f", struct.pack(">6H", *block[26:32]))
    iec104 = [said_of(point, motor, state).number for point in LIKELY_PHASES]
    values = motor_values("D", motor, None)
    iec61850 = [values[f"D/GGIO1.AnIn{number}.mag.f"] for number in (7, 8, 9)]
    return [[*modbus], iec104, [float(one) for one in iec61850 if isinstance(one, float)]]


def test_a_fault_in_one_of_two_phases_is_told_as_that(repository: Repository) -> None:
    tell(repository, OPEN_PHASE)
    state = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    motor = state.motors[PUMP]
    assert motor.phase is None
    words = "a (72 %) or c (28 %)"
    assert told_by_all(motor, state) == [words, words, "[0.72, 0.0, 0.28]"]
    modbus, iec104, iec61850 = numbers_of_all(motor, state)
    assert modbus == pytest.approx(LIKELY)
    assert iec104 == iec61850 == pytest.approx([100 * one for one in LIKELY])


def test_a_phase_that_is_sure_is_told_alone(repository: Repository) -> None:
    tell(repository, replace(FAULT, phase_probabilities=(0.01, 0.98, 0.01)))
    state = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    assert told_by_all(state.motors[PUMP], state)[:2] == ["b", "b"]


def test_what_cannot_be_shorted_turns_has_no_likely_phases(repository: Repository) -> None:
    tell(repository, replace(OPEN_PHASE, kind=Kind.CONNECTION))
    state = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    motor = state.motors[PUMP]
    assert told_by_all(motor, state) == ["", None, "null"]
    modbus, iec104, iec61850 = numbers_of_all(motor, state)
    assert all(math.isnan(one) for one in (*modbus, *iec61850))
    assert iec104 == [0.0, 0.0, 0.0], "they are invalid"
