"""MOTOR.toml: what it accepts, and how it says what it refuses."""

import tomllib
from dataclasses import replace
from math import log
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, read_motor, read_plate
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import (
    ChannelNames,
    Connection,
    Limits,
    MachineParameters,
    Motor,
    ParametersSource,
    ParameterTolerances,
    Transformers,
)
from core.machines.sensors import SensorClass
from core.machines.typical import TYPICAL_TOLERANCES, typical_parameters
from testing.machines.motors import REFERENCE
from testing.machines.plausible_motors import plausible_motors

COMPLETE = """
[nameplate]
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2
connection = "delta"
rotor_bars = 28

[parameters]
stator_resistance_ohm = 8.4
rotor_resistance_ohm = 8.2
stator_leakage_H = 0.0328
rotor_leakage_H = 0.0328
stator_self_inductance_H = 0.4377
inertia_kgm2 = 0.0229

[intervals]
stator_resistance_ohm = [8.3, 8.5]

[channels]
ia = "I1"
ib = "I2"
ic = "I3"

[limits]
fault_level = 0.01

[sensors]
voltage_gain = 0.002
current_delay_s = 10e-6
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "PUMP-7.toml"
    path.write_text(text, "utf-8")
    return path


def test_reads_every_field(tmp_path: Path) -> None:
    motor = read_motor(written(tmp_path, COMPLETE))
    assert motor.name == "PUMP-7"
    assert motor.nameplate.connection is Connection.DELTA
    assert motor.nameplate.rated_torque_Nm == pytest.approx(5.093, abs=1e-3)
    assert motor.parameters.magnetising_inductance_H == pytest.approx(0.65655)
    assert motor.channels.currents == ("I1", "I2", "I3")
    assert motor.channels.phase_voltages is None
    assert motor.limits.fault_level == 0.01
    assert motor.sensors == SensorClass(voltage_gain=0.002, current_delay_s=10e-6)


def test_what_the_file_does_not_say_of_the_sensors_is_typical_of_the_relay() -> None:
    table = tomllib.loads(COMPLETE)
    typical = SensorClass(0.02, 0.03, 40e-6, 50e-6)
    motor = motor_from_table(table, name="PUMP-7", source="motors.toml", typical=typical)
    assert motor.sensors == SensorClass(0.002, 0.03, 40e-6, 10e-6)


@pytest.mark.parametrize(
    ("old", "new", "field", "expected"),
    [
        ("rated_power_W = 800", "", "[nameplate] rated_power_W", "a number above zero"),
        ("rated_power_W = 800", "rated_power_W = -1", "[nameplate] rated_power_W", "a number above zero"),
        ("rated_power_W = 800", "rated_power_W = true", "[nameplate] rated_power_W", "a number above zero"),
        ("rated_power_W = 800", "rated_power_W = nan", "[nameplate] rated_power_W", "a number above zero"),
        ("pole_pairs = 2", "pole_pairs = 1.5", "[nameplate] pole_pairs", "a whole number"),
        ('"delta"', '"zigzag"', "[nameplate] connection", '"star" or "delta"'),
        ('ib = "I2"', "", "[channels] ib", "a channel name"),
        ('ib = "I2"', "ib = 2", "[channels] ib", "a channel name"),
        (
            "[limits]",
            "[limit]",
            "limit",
            "one of the tables [nameplate], [parameters], [intervals], [channels], [limits]",
        ),
        ("[8.3, 8.5]", "[8.5, 8.3]", "[intervals] stator_resistance_ohm", "[low, high]"),
        ("[8.3, 8.5]", "8.4", "[intervals] stator_resistance_ohm", "[low, high]"),
        ("[8.3, 8.5]", "[8.3, true]", "[intervals] stator_resistance_ohm", "[low, high]"),
        ("[intervals]", "[intervals]\nslip = [1, 2]", "[intervals] slip", "one of inertia_kgm2"),
        ("fault_level", "fault_levle", "[limits] fault_levle", "one of fault_level"),
        (
            "voltage_gain = 0.002",
            "voltage_gain = 0.2",
            "[sensors] voltage_gain",
            "0.0001 to 0.1 as a fraction",
        ),
        ("_s = 10e-6", "_s = 10", "[sensors] current_delay_s", "0.0000001 to 0.0005 s (25e-6 is +-25 us)"),
        ("voltage_gain", "gain", "[sensors] gain", "one of current_delay_s, current_gain, voltage_delay_s"),
        ("fault_level = 0.01", "fault_level = 3", "[limits] fault_level", "a fraction of at most 0.2"),
        (
            'ib = "I2"',
            'ib = "I2"\nfoo = "bar"',
            "[channels] foo",
            "one of ia, ib, ic, va, vab, vb, vbc, vc, vca",
        ),
        ("= 0.0229", "= 1e-6", "[parameters] inertia_kgm2", "0.000195 to 32.4 kg m^2 (0.003 to 500 s of"),
        ("= 0.0229", "= 1" + "0" * 399, "[parameters] inertia_kgm2", "0.000195 to 32.4 kg m^2"),
        ("= 0.0229", "= 1" + "0" * 4999, "file", "valid TOML in UTF-8"),
        (
            "= 0.4377",
            "= 1e300",
            "[parameters] stator_self_inductance_H",
            "0.115 to 34.5 H (0.1 to 30 per unit",
        ),
        (
            "= 0.4377",
            "= inf",
            "[parameters] stator_self_inductance_H",
            "a number above zero, 0.115 to 34.5 H",
        ),
        (
            "= 8.4",
            "= 8.4e3",
            "[parameters] stator_resistance_ohm",
            "0.271 to 271 ohm (0.0005 to 0.5 per unit",
        ),
        (
            "rotor_leakage_H = 0.0328",
            "rotor_leakage_H = 32.8",
            "[parameters] rotor_leakage_H",
            " H (0.005 to 1 ",
        ),
        ("= 800", "= 0.8", "[nameplate] rated_power_W", "10 to 6,580,000 W (0.01 to 10,000 A at 380 V)"),
        ("= 380", "= 3.8e5", "[nameplate] rated_voltage_V", "10 to 50,000 V"),
        ("= 50", "= 5", "[nameplate] rated_frequency_Hz", "10 to 400 Hz"),
        (
            "pole_pairs = 2",
            "pole_pairs = 1" + "0" * 399,
            "[nameplate] pole_pairs",
            "a whole number of 1 to 100",
        ),
        ("[8.3, 8.5]", "[8.3, 1" + "0" * 399 + "]", "[intervals] stator_resistance_ohm", "computer can hold"),
        ('"I1"', "[" * 20_000, "file", "valid TOML"),
        ("[parameters]", "[[parameters]]", "[parameters]", "a table"),
        ("[parameters]", "[parameters", "file", "valid TOML"),
    ],
)
def test_refusal_names_file_field_and_expectation(
    tmp_path: Path, old: str, new: str, field: str, expected: str
) -> None:
    assert old in COMPLETE
    with pytest.raises(MotorFileError) as refusal:
        read_motor(written(tmp_path, COMPLETE.replace(old, new, 1)))
    assert refusal.value.field == field
    assert expected in refusal.value.expected
    assert "PUMP-7.toml" in str(refusal.value)
    assert len(str(refusal.value)) < 500


def test_a_missing_file_and_a_missing_table_are_named(tmp_path: Path) -> None:
    with pytest.raises(MotorFileError, match="readable TOML file"):
        read_motor(tmp_path / "nowhere.toml")
    with pytest.raises(MotorFileError, match=r"\[nameplate\]: expected a table, found nothing"):
        read_motor(written(tmp_path, ""))
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(MotorFileError, match="valid TOML in UTF-8"):
        read_motor(tmp_path / "binary.toml")


def test_a_motor_without_parameters_has_those_typical_of_its_rating(tmp_path: Path) -> None:
    bare = written(tmp_path, COMPLETE[: COMPLETE.index("[parameters]")])
    plate = read_plate(bare)
    assert plate.parameters is None
    assert plate.nameplate.rated_power_W == 800
    motor = read_motor(bare)
    assert motor.parameters_source is ParametersSource.TYPICAL
    assert motor.is_typical
    assert motor.parameters == typical_parameters(motor.nameplate).parameters
    assert motor.tolerances == TYPICAL_TOLERANCES


@pytest.mark.parametrize("source", ParametersSource)
def test_a_file_says_where_its_parameters_come_from(tmp_path: Path, source: ParametersSource) -> None:
    said = COMPLETE.replace("[parameters]", f'[parameters]\nsource = "{source}"')
    assert read_motor(written(tmp_path, said)).parameters_source is source
    assert read_plate(tmp_path / "PUMP-7.toml").parameters is not None


def test_parameters_with_intervals_are_commissioned_and_others_given(tmp_path: Path) -> None:
    assert read_motor(written(tmp_path, COMPLETE)).parameters_source is ParametersSource.COMMISSIONED
    given_ones = COMPLETE.replace("[intervals]\nstator_resistance_ohm = [8.3, 8.5]\n", "")
    motor = read_motor(written(tmp_path, given_ones))
    assert (motor.parameters_source, motor.is_typical) == (ParametersSource.GIVEN, False)
    unknown = COMPLETE.replace("[parameters]", '[parameters]\nsource = "hearsay"')
    with pytest.raises(MotorFileError, match=r"source: expected one of given, commissioned, .* 'hearsay'"):
        read_motor(written(tmp_path, unknown))


def test_a_wide_interval_widens_the_tolerance_and_a_narrow_one_does_not(tmp_path: Path) -> None:
    wide = COMPLETE.replace("[8.3, 8.5]", "[4.2, 10.0]")
    assert read_motor(written(tmp_path, wide)).tolerances == ParameterTolerances(log(2.0))
    assert read_motor(written(tmp_path, COMPLETE)).tolerances == ParameterTolerances()


names = st.text(min_size=1, max_size=12).filter(lambda text: text.isprintable() or text == "\x7f")


@given(
    plausible=plausible_motors(),
    currents=st.one_of(st.none(), st.tuples(names, names, names)),
    sensors=st.sampled_from([SensorClass(), SensorClass(0.002, 0.003, 1e-5, 2e-5)]),
    transformers=st.sampled_from([Transformers(), Transformers(30.0), Transformers(30.0, 80.0)]),
)
def test_what_is_written_is_read_again(
    tmp_path_factory: pytest.TempPathFactory,
    plausible: Motor,
    currents: tuple[str, str, str] | None,
    sensors: SensorClass,
    transformers: Transformers,
) -> None:
    channels = ChannelNames(currents=currents)
    motor = replace(
        plausible, channels=channels, limits=Limits(0.02), sensors=sensors, transformers=transformers
    )
    inertia = motor.parameters.inertia_kgm2
    path = tmp_path_factory.mktemp("motor") / "PUMP-7.toml"
    write_motor(
        path,
        motor,
        intervals={"inertia_kgm2": (inertia * 0.9, inertia * 1.1)},
        remarks={"rotor_leakage_H": "fixed\nand said"},
        heading="two\nlines",
    )
    again = read_motor(path)
    assert again.channels == motor.channels
    assert again.nameplate.connection is motor.nameplate.connection
    assert again.limits == motor.limits
    assert again.sensors == motor.sensors
    assert again.transformers == motor.transformers
    assert ("[sensors]" in path.read_text()) is (sensors != SensorClass())
    for name in MachineParameters.__slots__:
        assert getattr(again.parameters, name) == pytest.approx(getattr(motor.parameters, name), rel=1e-6)


def test_a_motor_that_could_not_be_read_again_is_not_written(tmp_path: Path) -> None:
    heavy = replace(REFERENCE, parameters=replace(REFERENCE.parameters, inertia_kgm2=1e6))
    with pytest.raises(MotorFileError, match=r"\[parameters\] inertia_kgm2: expected .* found 1000000"):
        write_motor(tmp_path / "PUMP-7.toml", heavy)
    assert list(tmp_path.iterdir()) == []
