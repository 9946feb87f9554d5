"""Whatever a motor file says: it is refused in words, or a record is diagnosed with finite figures."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.diagnosis.errors import DiagnosisError
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Diagnosis, Verdict, not_finite
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table
from core.machines.parameters import Motor
from core.machines.plausibility import plausible_parameters
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.machines.plausible_motors import between, plausible_motors, scaled_to

RECORDS = {
    motor.name: [
        recording(running(motor, load_level, fault=fault), noise=0.003, seconds=0.2)
        for load_level, fault in ((0.6, None), (0.3, Fault(0.05, 1)))
    ]
    for motor in ALL
}
FEW = settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])
MANY = settings(FEW, max_examples=250)

anything: st.SearchStrategy[object] = st.one_of(
    st.floats(),
    st.integers(),
    st.sampled_from([10**400, -(10**400), 1e300, 1e-300, 5e-324, True, None, "0.1", [], {}]),
)


def checked(result: Diagnosis) -> None:
    assert json.dumps(result.as_dict(), allow_nan=False)
    assert result.reasons


def table_of(motor: Motor) -> dict[str, dict[str, object]]:
    return {"nameplate": asdict(motor.nameplate), "parameters": asdict(motor.parameters)}


@st.composite
def tables(draw: st.DrawFn) -> tuple[str, Mapping[str, object]]:
    """A motor's tables with figures from the ends of their ranges, or none that belongs there."""
    motor = draw(st.sampled_from(ALL))
    table = table_of(motor)
    for one in draw(st.lists(st.sampled_from(list(plausible_parameters(motor.nameplate))), max_size=3)):
        ends = st.sampled_from([one.least * 1.001, one.most / 1.001])
        table["parameters"][one.field] = draw(ends | between(one.least, one.most))
    if draw(st.booleans()):
        part = draw(st.sampled_from(["nameplate", "parameters"]))
        table[part][draw(st.sampled_from(sorted(table[part])))] = draw(anything)
    return motor.name, table


def motor_or_refusal(table: Mapping[str, object], name: str) -> Motor | str:
    try:
        return motor_from_table(table, name=name, source="PUMP-7.toml")
    except MotorFileError as error:
        return str(error)


def refused_or_diagnosed(case: tuple[str, Mapping[str, object]]) -> None:
    name, table = case
    motor = motor_or_refusal(table, name)
    if isinstance(motor, str):
        assert motor.startswith("PUMP-7.toml: ")
        assert len(motor) < 500
        return
    for record in RECORDS[name]:
        checked(diagnose(record, motor))


@FEW
@given(tables())
def test_a_motor_file_is_refused_or_diagnoses_a_record(case: tuple[str, Mapping[str, object]]) -> None:
    refused_or_diagnosed(case)


@pytest.mark.campaign
@MANY
@given(tables())
def test_many_motor_files_are_refused_or_diagnose_a_record(case: tuple[str, Mapping[str, object]]) -> None:
    refused_or_diagnosed(case)


@pytest.mark.campaign
@MANY
@given(plausible_motors(frequency_Hz=50.0))
def test_a_motor_of_any_rating_diagnoses_a_record(motor: Motor) -> None:
    checked(diagnose(scaled_to(RECORDS["reference"][1], REFERENCE.nameplate, motor.nameplate), motor))


@pytest.mark.filterwarnings("ignore:.*encountered:RuntimeWarning")
@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("inertia_kgm2", 1e-12),
        ("stator_self_inductance_H", 1e300),
        ("rotor_resistance_ohm", math.inf),
        ("rotor_resistance_ohm", math.nan),
    ],
)
def test_a_motor_that_no_file_describes_is_undiagnosable(field: str, value: float) -> None:
    """A program may hand over what a file may not; the machine's equations then give no figures."""
    motor = replace(REFERENCE, parameters=replace(REFERENCE.parameters, **{field: value}))
    result = diagnose(RECORDS["reference"][0], motor)
    assert (result.verdict, result.mu_f) == (Verdict.UNDIAGNOSABLE, None)
    assert "give no finite figures" in result.reasons[0]
    checked(result)


@pytest.mark.filterwarnings("ignore:.*encountered:RuntimeWarning")
def test_a_baseline_of_a_motor_that_no_file_describes_is_refused() -> None:
    motor = replace(REFERENCE, parameters=replace(REFERENCE.parameters, rotor_resistance_ohm=math.nan))
    with pytest.raises(DiagnosisError, match="not fit for a baseline: current"):
        learn_baseline([RECORDS["reference"][0]] * 3, motor)


@pytest.mark.parametrize(
    ("document", "way"),
    [
        ({"a": 1, "b": [1.0, {"c": None, "d": "nan"}]}, None),
        ({"a": {"b": [0.0, math.nan]}}, "a.b.1"),
        ({"a": (1.0, -math.inf)}, "a.1"),
        ([[[10**400]]], "0.0.0"),
        (math.inf, "the document"),
    ],
)
def test_the_way_to_what_is_not_finite_is_told(document: object, way: str | None) -> None:
    assert not_finite(document) == way
