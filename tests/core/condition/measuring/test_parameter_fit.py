"""Over several records, parameters of the motor's file that do not fit are named, and right ones are not."""

from collections.abc import Sequence
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from core.condition.events import Event, EventKind
from core.condition.following.follower import Follower
from core.condition.kinds import State
from core.condition.measuring.parameter_fit import counts
from core.condition.observation import Observation, VoltageChannels
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Motor, ParametersSource
from core.machines.typical import TYPICAL_TOLERANCES
from core.signals.sequence import PhaseSequence
from testing.machines.motors import MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.phase_circuits import FORTESCUE, Fault, running

HOUR_NS = 3600 * 10**9
LOADS = (0.15, 0.3, 0.45, 0.6, 0.75, 0.9)


def observations(
    motor: Motor,
    loads: Sequence[float] = LOADS * 2,
    *,
    offset_s: float = 40e-6,
    seed: int = 1,
    fault: Fault | None = None,
) -> list[Observation]:
    """Hourly records of a motor whose relay has channels of the usual class."""
    random = np.random.default_rng(seed)
    gains = 1.0 + random.uniform(-0.01, 0.01, (2, 3))
    delays = random.uniform(-25e-6, 25e-6, (2, 3))
    delays[0] += offset_s
    ratios = gains * np.exp(-2j * pi * 50.0 * delays)
    found = []
    for hour, load_level in enumerate(loads):
        at = running(motor, load_level, fault=fault, unbalance=complex(*random.normal(0.0, 0.003, 2)))
        noise = 2e-4 * random.normal(size=(2, 3)) * np.exp(2j * pi * random.uniform(size=(2, 3)))
        terminals = np.array([at.line_current, at.phase_voltage]) * ratios
        terminals += noise * np.abs(terminals).mean(axis=1)[:, np.newaxis]
        sequences = np.sqrt(2.0) * np.linalg.solve(FORTESCUE, terminals.T)
        if motor.nameplate.connection == "delta":
            turn = np.exp(1j * pi / 6.0)
            sequences[1] *= [turn / np.sqrt(3.0), turn * np.sqrt(3.0)]
            sequences[2] *= [turn.conjugate() / np.sqrt(3.0), turn.conjugate() * np.sqrt(3.0)]
        found.append(
            Observation(
                time_ns=hour * HOUR_NS,
                recorder="relay",
                sequence=PhaseSequence.ABC,
                voltage_channels=VoltageChannels.PHASE,
                frequency_hz=50.0,
                positive_voltage_V=complex(sequences[1, 1]),
                negative_voltage_V=complex(sequences[2, 1]),
                zero_voltage_V=complex(sequences[0, 1]),
                positive_current_A=complex(sequences[1, 0]),
                negative_current_A=complex(sequences[2, 0]),
                zero_current_A=complex(sequences[0, 0]),
                scatter=1e-7,
                cycles=25,
                load_level=load_level,
            )
        )
    return found


def with_wrong(motor: Motor, name: str, factor: float) -> Motor:
    machine = motor.parameters
    return replace(motor, parameters=replace(machine, **{name: factor * getattr(machine, name)}))


def followed(file: Motor, records: Sequence[Observation]) -> Follower:
    follower = Follower(file)
    for record in records:
        follower.fold(record)
    return follower


def named(follower: Follower) -> tuple[str, ...]:
    assessment = follower.assessment()
    assert assessment is not None
    return tuple(one.name for one in assessment.parameter_errors)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, VERY_LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("factor", [0.75, 1.25])
def test_a_wrong_magnetising_inductance_is_named_with_its_error(motor: Motor, factor: float) -> None:
    file = with_wrong(motor, "stator_self_inductance_H", factor)
    follower = followed(file, observations(motor))
    assert named(follower) == ("L_s",)
    assessment = follower.assessment()
    assert assessment is not None
    (error,) = assessment.parameter_errors
    assert error.error == pytest.approx(1.0 / factor - 1.0, abs=max(0.12, 3.0 * error.deviation))
    condition = condition_of(file, assessment, assessment.as_of_ns)
    assert condition.reasons[0].startswith(
        "the parameters in the motor's file do not fit its records (L_s): commission this motor"
    )
    assert "Commission this motor (mcc commission)" in condition.advice


@pytest.mark.parametrize("seed", range(6))
def test_right_parameters_are_not_blamed_for_usual_sensors(seed: int) -> None:
    for motor in (REFERENCE, MEDIUM, VERY_LARGE):
        follower = followed(motor, observations(motor, offset_s=(seed - 3) * 40e-6, seed=seed))
        assert named(follower) == ()
        assessment = follower.assessment()
        assert assessment is not None
        condition = condition_of(motor, assessment, assessment.as_of_ns)
        if condition.state is State.HEALTHY:
            assert condition.advice == "Nothing needs to be done."


@pytest.mark.parametrize("level", [0.01, 0.03, 0.06, 0.1])
def test_shorted_turns_are_not_blamed_on_parameters(level: float) -> None:
    for motor in (REFERENCE, MEDIUM, VERY_LARGE):
        assessment = followed(motor, observations(motor, fault=Fault(level, 1))).assessment()
        assert assessment is not None
        condition = condition_of(motor, assessment, assessment.as_of_ns)
        assert "commission" not in condition.advice.lower()
        assert not any("parameters" in reason for reason in condition.reasons)


def test_few_records_and_typical_parameters_name_nothing() -> None:
    wrong = with_wrong(MEDIUM, "stator_self_inductance_H", 0.7)
    assert named(followed(wrong, observations(MEDIUM)[:5])) == ()
    typical = replace(wrong, parameters_source=ParametersSource.TYPICAL, tolerances=TYPICAL_TOLERANCES)
    assert named(followed(typical, observations(MEDIUM))) == ()


def test_a_corrected_file_takes_the_blame_away_and_a_saved_state_keeps_it() -> None:
    wrong = with_wrong(MEDIUM, "stator_self_inductance_H", 0.75)
    records = observations(MEDIUM, LOADS * 4)
    follower = followed(wrong, records[:12])
    assert named(Follower.restore(wrong, follower.save())) == ("L_s",)
    follower.apply(Event(12 * HOUR_NS, EventKind.PARAMETERS_EDITED, "stator_self_inductance_H"), MEDIUM)
    assert named(follower) == ()
    for record in records[12:]:
        follower.fold(record)
    assert named(follower) == ()


def test_of_many_records_only_some_are_taken_in() -> None:
    taken = [number for number in range(200) if counts(float(number))]
    assert taken[:24] == list(range(24))
    assert taken[24:] == list(range(32, 200, 32))
