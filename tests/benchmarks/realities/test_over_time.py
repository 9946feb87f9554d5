"""What plants do to motors over time: the currents beside a motor, and the tables of what became of it."""

import numpy as np
import pytest

from benchmarks.condition.circuit import BACKWARD, FORWARD
from benchmarks.condition.courses import healthy
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import true_phasors
from benchmarks.realities.histories import Reality, happens, rated_current_A, with_elements
from benchmarks.realities.over_time import Task, cells, counted, follow_history, tables

A = np.exp(2j * np.pi / 3)


@pytest.mark.parametrize("between", [0, 1, 2])
def test_an_element_draws_both_sequences_in_a_fixed_ratio(between: int) -> None:
    siemens = np.zeros((1, 3), np.complex128)
    siemens[0, between] = 0.3 - 0.2j
    beside = with_elements(healthy(1), siemens).beside
    assert beside is not None
    current = beside[0] @ FORWARD
    positive, negative = current @ np.conj(FORWARD) / 3.0, current @ np.conj(BACKWARD) / 3.0
    assert positive == pytest.approx(0.3 - 0.2j)
    opposite = (between + 2) % 3
    assert negative == pytest.approx(-(A**opposite) * positive)


@pytest.mark.parametrize("reality", [Reality.HEATER, Reality.CAPACITOR_LOST, Reality.SECOND_MOTOR])
def test_what_hangs_beside_a_motor_changes_its_feeder_s_current_from_its_record_on(reality: Reality) -> None:
    random = np.random.default_rng(3)
    simulated = draw_motor(random)
    happened = happens(random, simulated, (reality,), 0.0, 4, 4, 4)
    operation = draw_operation(random, len(happened.course))
    voltage, current = true_phasors(simulated, operation, happened.course)
    sound_voltage, sound = true_phasors(simulated, operation, healthy(len(happened.course)))
    assert voltage == pytest.approx(sound_voltage)
    more = np.abs(current - sound).max(axis=1) / np.sqrt(2.0) / rated_current_A(simulated)
    if reality is Reality.CAPACITOR_LOST:
        assert np.all(more[:4] > 0.01), "the bank is there before"
    else:
        assert more[:4] == pytest.approx(0.0)
    if reality is Reality.HEATER:
        assert more[4:] == pytest.approx(0.06, rel=0.1)


def test_the_tables_have_a_row_for_every_cell() -> None:
    chosen = cells()[0], cells()[1]
    found = {f"{cell.name}|{cell.level}": counted([follow_history(Task(cell, 1))]) for cell in chosen}
    lines = "\n".join(tables(found, {}))
    assert found[f"{chosen[0].name}|0.0"].false == 0
    assert found[f"{chosen[1].name}|0.05"].soon == 1
    assert lines.count(Reality.VOLTAGE_DRIFT.value) == 2
