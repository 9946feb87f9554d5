"""The first reason that a person reads names the cause, not what follows from it: a kind of record a row."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.commissioning.start_detection import start_of
from core.diagnosis.stator import diagnose
from core.recordings import Recording
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.disturbed_records import record_of
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from tests.core.diagnosis.spoiling import CURRENTS, VOLTAGES, clipped, edited, frozen, pulsed, repeated

RATE = 10_000.0
BEFORE = 800
"""Samples before the contactor closes."""


@cache
def steady() -> Recording:
    return recording(running(REFERENCE, 0.6), noise=0.002)


@cache
def started(motor: int, load: float) -> Recording:
    """Eighty milliseconds of nothing, then a direct start; the voltages are those behind the contactor."""
    plate = ALL[motor].nameplate
    plant = MotorPlant(
        ALL[motor], Supply(plate.rated_voltage_V, plate.rated_frequency_Hz), Load(load), Sensors(1.0, 1.0)
    )
    seen = plant.start_up(0.0, 0.7, RATE)
    true = np.pad(np.vstack([seen.currents_A, seen.voltages_V]), ((0, 0), (BEFORE, 0)))
    noise = np.random.default_rng(1).standard_normal(true.shape)
    return record_of(true + 1e-3 * true.std(axis=1, keepdims=True) * noise, RATE)


def cut(record: Recording, first: int, last: int | None = None) -> Recording:
    return replace(record, samples=record.samples[:, first:last])


def on_the_busbar(record: Recording) -> Recording:
    """The same start, the voltage transformers before the contactor."""
    samples = record.samples.copy()
    per_cycle = round(RATE / 50.0)
    for k in range(BEFORE // per_cycle):
        here = slice(BEFORE - (k + 1) * per_cycle, BEFORE - k * per_cycle)
        samples[VOLTAGES, here] = samples[VOLTAGES, -per_cycle:]
    return replace(record, samples=samples)


def stopped(record: Recording) -> Recording:
    samples = record.samples.copy()
    samples[CURRENTS, 4_000:] *= 1e-3
    return replace(record, samples=samples)


def noisy_standstill(record: Recording) -> Recording:
    """A motor that is off, seen through converters of which a step is more than the noise."""
    samples = record.samples.copy()
    noise = np.random.default_rng(2).standard_normal(samples[CURRENTS].shape)
    samples[CURRENTS] = 0.005 * np.round(noise / 2.5)
    return replace(record, samples=samples)


def at_frequency(hertz: float) -> Recording:
    return recording(running(REFERENCE, 0.5), frequency_hz=hertz, noise=0.002)


def locked(record: Recording) -> Recording:
    machine, w = REFERENCE.parameters, REFERENCE.nameplate.rated_angular_frequency
    reactance = w * (machine.stator_leakage_H + machine.rotor_leakage_H)
    impedance = machine.stator_resistance_ohm + machine.rotor_resistance_ohm + 1j * reactance
    truth = running(REFERENCE, 0.5)
    return recording(replace(truth, line_current=truth.phase_voltage / impedance), noise=0.002)


ORDER: list[tuple[str, str, Callable[[], Recording]]] = [
    ("a start", "start: the motor starts", lambda: started(0, 0.6)),
    ("a start without load", "start: the motor starts", lambda: started(0, 0.0)),
    ("a start, busbar voltage", "start: the motor starts", lambda: on_the_busbar(started(0, 0.6))),
    ("a start with crests cut off", "start: the motor starts", lambda: clipped(started(0, 0.6), 0, 0.6)),
    ("a start of a wrong ratio", "start: the motor starts", lambda: edited(started(0, 0.6), CURRENTS, 0.05)),
    ("the end of a start", "start: the motor runs up", lambda: cut(started(0, 0.6), BEFORE + 100)),
    ("a stop", "stop: the motor is switched off", lambda: stopped(steady())),
    ("a stop with the voltage", "stop", lambda: edited(
        stopped(steady()), VOLTAGES, np.linspace(1, 0, 6_000))),
    ("a locked rotor", "running: a start, or a stalled motor", lambda: locked(steady())),
    ("off, voltage on", "not-running: there is no current", lambda: noisy_standstill(steady())),
    ("all off", "not-running: there is neither voltage", lambda: edited(
        steady(), CURRENTS + VOLTAGES, 0.0)),
    ("held samples", "held samples IB", lambda: repeated(steady(), [1], 40)),
    ("held samples everywhere", "held samples VA", lambda: repeated(steady(), CURRENTS + VOLTAGES, 40)),
    ("held samples at 42 Hz", "held samples V", lambda: repeated(at_frequency(42.0), VOLTAGES, 40)),
    ("held samples of a stalled motor", "held samples I", lambda: repeated(locked(steady()), CURRENTS, 40)),
    ("another frequency, crests cut", "frequency", lambda: clipped(at_frequency(42.0), 4, 0.9)),
    ("another frequency, a voltage lost", "frequency", lambda: edited(at_frequency(42.0), [4], 0.1)),
    ("a drive that clips", "drive", lambda: pulsed(steady(), 4_000.0)),
    ("a voltage lost, load rising", "voltage loss", lambda: edited(
        edited(steady(), [4], 0.1), CURRENTS, np.linspace(1.0, 2.0, 6_000))),
    ("voltages missing", "voltage: current flows but", lambda: edited(steady(), VOLTAGES, 0.0)),
    ("a low voltage, a current lost", "voltage", lambda: edited(edited(steady(), VOLTAGES, 0.2), [1], 0.0)),
    ("a current lost, another scaled", "phase loss", lambda: edited(edited(steady(), [1], 0.0), [2], 0.7)),
    ("one current reversed", "current polarity", lambda: edited(steady(), [2], -1.0)),
    ("a dip", "no shorted turns seen", lambda: edited(steady(), VOLTAGES, np.repeat([1.0, 0.75], 3_000))),
    ("two dips", "supply steadiness", lambda: edited(steady(), VOLTAGES, np.repeat(
        [1.0, 0.75, 1.0, 0.75, 1.0, 0.75], 1_000))),
    ("load rising", "steadiness", lambda: edited(steady(), CURRENTS, np.linspace(1.0, 1.8, 6_000))),
    ("a sample missing in a start", "missing samples", lambda: frozen(started(0, 0.6), [1], 50, 51, np.nan)),
    ("shorted turns", "shorted turns in phase b", lambda: recording(
        running(REFERENCE, 0.6, fault=Fault(0.06, 1)), noise=0.002)),
    ("nothing", "no shorted turns seen above the limit", steady),
    ("a voltage channel off", "wrong voltage channel (100%): channel a: error of +5", lambda: edited(
        steady(), [3], 1.06)),
]  # fmt: skip


@pytest.mark.parametrize(("first", "made"), [row[1:] for row in ORDER], ids=[row[0] for row in ORDER])
def test_the_first_reason_is_the_cause(first: str, made: Callable[[], Recording]) -> None:
    assert diagnose(made(), REFERENCE).reasons[0].startswith(first)


@pytest.mark.parametrize("motor", range(len(ALL)), ids=[motor.name for motor in ALL])
def test_a_start_says_what_it_is_good_for(motor: int) -> None:
    """What is told to be a start is one that commissioning takes."""
    record = started(motor, 0.3)
    (reason,) = diagnose(record, ALL[motor]).reasons
    assert reason.startswith("start: the motor starts")
    assert "`mcc commission`" in reason
    assert start_of(record, ALL[motor].nameplate, ALL[motor].channels).sample_rate_hz == RATE


def test_a_hint_without_voltages_says_so_next_to_its_verdict() -> None:
    record = recording(running(REFERENCE, 0.6, fault=Fault(0.08, 2)), noise=0.002)
    first, second = diagnose(record, REFERENCE, currents_only=True).reasons[:2]
    assert first.startswith("shorted turns in phase c")
    assert second.startswith("no voltages recorded")
