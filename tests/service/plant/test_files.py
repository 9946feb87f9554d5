from pathlib import Path

import pytest

import scl
from core.machines.sensors import SensorClass
from service.configuration.settings import Settings
from service.plant import Bus, Overrides, PlantError, Schedule, read_plant
from testing.service.busbar import BUSBAR, scd_with_a_busbar

DEMO_MOTORS = Path(__file__).parents[3] / "service" / "demo" / "motors.toml"


@pytest.fixture
def motors(tmp_path: Path) -> Path:
    """A copy of the demo's motors file, to be changed."""
    copy = tmp_path / "motors.toml"
    copy.write_bytes(DEMO_MOTORS.read_bytes())
    return copy


def settings(motors: Path, plant: Path = scl.DEMO_PLANT_SCD) -> Settings:
    return Settings(scd=plant, motors=motors)


def test_the_demo_plant(motors: Path) -> None:
    plant = read_plant(settings(motors))
    assert [site.name for site in plant.sites] == ["FACTORY_A", "FACTORY_B"]
    assert [motor.name for motor in plant.motors] == [
        "PUMP-A1",
        "FAN-A2",
        "MILL-A3",
        "CONVEYOR-B1",
        "COMPRESSOR-B2",
        "PUMP-B3",
    ]
    motor = plant.motor("FAN-A2")
    assert (motor.site, motor.relay, motor.motor.nameplate.rated_power_W) == ("FACTORY_A", "A2_SEL710", 7500)
    assert plant.motor_of("A2_SEL710") is motor
    relay = plant.relay("A2_SEL710")
    assert (relay.host, relay.port, relay.manufacturer) == ("127.0.0.1", 10211, "SEL")
    assert relay.trigger_control == "A2_SEL710CON/RBGGIO1.SPCSO01"
    assert relay.record_made == "A2_SEL710PRO/FLTRDRE1.RcdMade"
    assert relay.fault_number == "A2_SEL710PRO/FLTRDRE1.FltNum"
    assert relay.report_control == "A2_SEL710CFG/LLN0.BR.BRep01"
    assert relay.metering_data_set == "A2_SEL710CFG/LLN0.DSet02"


def test_a_motor_may_have_long_records_of_its_own(motors: Path) -> None:
    told = 'name = "FAN-A2"\nlong_record_days = 7\nlong_record_s = 20'
    motors.write_text(motors.read_text().replace('name = "FAN-A2"', told))
    plant = read_plant(settings(motors))
    fan, pump = plant.motor("FAN-A2"), plant.motor("PUMP-A1")
    assert (fan.long_record_days, fan.long_record_s) == (7.0, 20.0)
    assert (pump.long_record_days, pump.long_record_s) == (None, None)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'name = "FAN-A2"',
            'name = "FAN-A2"\nlong_record_s = 60',
            "motor FAN-A2: long_record_s: expected length of a long record [s], 1 to 30, found 60",
        ),
        ('name = "FAN-A2"', 'name = "FAN-A3"', "motor FAN-A2: expected its [[motor]] table"),
        (
            'name = "FAN-A2"',
            'name = "PUMP-A1"',
            "motor 2: name: expected each motor once, found PUMP-A1 again",
        ),
        ('name = "FAN-A2"', "name = 2", "motor 2: name: expected the motor's name, found 2"),
        ("rated_power_W = 7500", "rated_power_W = -1", "motor FAN-A2: [nameplate] rated_power_W: expected"),
        (
            "# The demo",
            "motors = 6 # The demo",
            "top level: expected [[motor]], [[relay]] and [[bus]] tables and nothing else, found motors "
            "(did you mean motor?)",
        ),
        ("[[motor]]", "[[motor", "expected valid TOML in UTF-8"),
    ],
)
def test_what_is_wrong_in_the_motors_file_is_named(motors: Path, old: str, new: str, message: str) -> None:
    content = motors.read_text()
    assert old in content
    motors.write_text(content.replace(old, new))
    with pytest.raises(PlantError) as failure:
        read_plant(settings(motors))
    assert f"{motors}: " in str(failure.value)
    assert message in str(failure.value)


def test_a_motor_the_scd_does_not_have(motors: Path) -> None:
    content = motors.read_text()
    extra = content[content.index('name = "PUMP-A1"') : content.index('name = "FAN-A2"') - len("[[motor]]\n")]
    motors.write_text(content + "\n[[motor]]\n" + extra.replace("PUMP-A1", "PUMP-Z9"))
    with pytest.raises(
        PlantError,
        match=r"motor PUMP-Z9: relay: expected the name of its relay \(relay = \"NAME\" of a \[\[relay\]\] "
        r"table\), or a motor of demo_plant\.scd \(COMPRESSOR-B2.*found none",
    ):
        read_plant(settings(motors))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('type="MOT"', 'type="CBR"', "expected motors (ConductingEquipment"),
        ('name="FAN-A2"', 'name="PUMP-A1"', "motor PUMP-A1: expected one motor for one relay"),
        ('<P type="IP">127.0.0.1</P>', '<P type="IP">here</P>', "expected an IPv4 or IPv6 address"),
        (
            '<P type="MMS-Port">10211</P>',
            '<P type="MMS-Port">10210</P>',
            "relays A1_SEL710 and A2_SEL710: expected an address for each relay "
            "(host and port, or P elements IP and MMS-Port of its SCL), found 127.0.0.1:10210 for 2 of them",
        ),
        ('<P type="MMS-Port">10211</P>', '<P type="MMS-Port">70000</P>', "expected a port from 1 to 65535"),
        ("</SCL>", "", "expected"),
    ],
)
def test_what_is_wrong_in_the_scd_is_named(
    motors: Path, tmp_path: Path, old: str, new: str, message: str
) -> None:
    content = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    assert old in content
    damaged = tmp_path / "damaged.scd"
    damaged.write_text(content.replace(old, new), encoding="utf-8")
    with pytest.raises(PlantError) as failure:
        read_plant(settings(motors, damaged))
    assert "damaged.scd" in str(failure.value)
    assert message in str(failure.value)


def test_files_that_are_not_there(motors: Path, tmp_path: Path) -> None:
    with pytest.raises(PlantError, match=r"none\.toml: file: expected a TOML file .* found no file"):
        read_plant(settings(tmp_path / "none.toml"))
    with pytest.raises(PlantError, match="expected a readable file"):
        read_plant(settings(tmp_path))
    with pytest.raises(PlantError, match=r"none\.scd"):
        read_plant(settings(motors, tmp_path / "none.scd"))
    with pytest.raises(PlantError, match="settings: scd: expected the path of the plant's SCD file"):
        read_plant(Settings(motors=motors))


def test_a_relay_that_tells_of_no_record_is_taken_and_polled(motors: Path, tmp_path: Path) -> None:
    content = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8").replace("RcdMade", "RcdMad")
    (tmp_path / "old.scd").write_text(content, encoding="utf-8")
    relay = read_plant(settings(motors, tmp_path / "old.scd")).relay("A1_SEL710")
    assert (relay.record_made, relay.report_control) == (None, None)
    assert relay.trigger_control == "A1_SEL710CON/RBGGIO1.SPCSO01"


def test_a_relay_that_cannot_be_triggered_is_taken_all_the_same(motors: Path, tmp_path: Path) -> None:
    content = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8").replace("SPCSO01", "SPCSX01")
    (tmp_path / "readonly.scd").write_text(content, encoding="utf-8")
    relay = read_plant(settings(motors, tmp_path / "readonly.scd")).relay("A1_SEL710")
    assert relay.trigger_control is None
    assert relay.report_control == "A1_SEL710CFG/LLN0.BR.BRep01"


def test_the_motors_file_may_decide_about_the_relay(motors: Path) -> None:
    text = motors.read_text(encoding="utf-8")
    reports = 'reports_directory = "none"\nreport_date_order = "DMY"\nreport_power_unit = "kW"\n'
    decisions = f'trigger = "none"\nevents_directory = "COMTRADE"\n{reports}'
    table = f"[motor.relay]\n{decisions}\n[motor.nameplate]"
    motors.write_text(text.replace("[motor.nameplate]", table, 1))
    plant = read_plant(settings(motors))
    decided, left = plant.relays[:2]
    assert (decided.overrides.trigger, decided.overrides.events_directory) == ("none", "COMTRADE")
    assert decided.overrides.reports_directory == "none"
    assert (decided.overrides.report_date_order, decided.overrides.report_power_unit) == ("DMY", "kW")
    assert left.overrides == Overrides()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("trigger = 1", "relay.trigger: expected a control such as"),
        ('trigger = "RBGGIO1.SPCSO01"', "relay.trigger: expected a control such as"),
        (
            'report_control = "A1/LLN0.BRep01"',
            "relay.report_control: expected a report control block such as",
        ),
        ('trigger_action = "push"', "relay.trigger_action: expected 'set-reset' or 'pulse', found 'push'"),
        ('events_directory = ""', "relay.events_directory: expected a folder of the relay"),
        (
            'report_date_order = "YDM"',
            "relay.report_date_order: expected 'MDY' or 'YMD' or 'DMY', found 'YDM'",
        ),
        ('report_power_unit = "MW"', "relay.report_power_unit: expected 'W' or 'kW', found 'MW'"),
        ("reports_directory = 1", "relay.reports_directory: expected a folder of the relay"),
        (
            'folder = "EVENTS"',
            "relay.folder: expected one of trigger, trigger_action, report_control, events_",
        ),
    ],
)
def test_what_is_wrong_in_what_it_decides_is_named(motors: Path, line: str, message: str) -> None:
    text = motors.read_text(encoding="utf-8")
    motors.write_text(text.replace("[motor.nameplate]", f"[motor.relay]\n{line}\n\n[motor.nameplate]", 1))
    with pytest.raises(PlantError) as failure:
        read_plant(settings(motors))
    assert f"motor PUMP-A1: {message}" in str(failure.value)


def test_a_motor_may_have_a_schedule(motors: Path) -> None:
    text = motors.read_text(encoding="utf-8")
    motors.write_text(text.replace('name = "FAN-A2"', 'name = "FAN-A2"\nschedule = "30 6 * * MON"'))
    plant = read_plant(settings(motors))
    assert plant.motor("FAN-A2").schedule == Schedule("30 6 * * MON")
    assert plant.motor("PUMP-A1").schedule is None
    only_running = 'name = "FAN-A2"\nschedule_only_running = true\n'
    when = Schedule("30 6 * * MON", only_running=True)
    motors.write_text(text.replace('name = "FAN-A2"', f'{only_running}schedule = "30 6 * * MON"'))
    assert read_plant(settings(motors)).motor("FAN-A2").schedule == when
    motors.write_text(text.replace('name = "FAN-A2"', only_running))
    with pytest.raises(PlantError, match="schedule_only_running: expected a schedule beside it"):
        read_plant(settings(motors))
    motors.write_text(text.replace('name = "FAN-A2"', 'name = "FAN-A2"\nschedule = "at dawn"'))
    with pytest.raises(PlantError, match=r"motor FAN-A2: schedule: expected 5 fields.*found 'at dawn'"):
        read_plant(settings(motors))


def test_the_motors_file_says_which_motors_share_a_bus(motors: Path) -> None:
    text = motors.read_text(encoding="utf-8")
    for name, bus in [("PUMP-A1", "MCC-A"), ("FAN-A2", "MCC-A"), ("PUMP-B3", "MCC-B")]:
        text = text.replace(f'name = "{name}"', f'name = "{name}"\nbus = "{bus}"')
    motors.write_text(
        text + '\n[[bus]]\nname = "MCC-A"\nschedule = "0 * * * *"\ncommon_voltage_transformer = true\n'
    )
    plant = read_plant(settings(motors))
    assert plant.buses == (
        Bus("MCC-A", ("PUMP-A1", "FAN-A2"), Schedule("0 * * * *"), common_voltage_transformer=True),
        Bus("MCC-B", ("PUMP-B3",)),
    )
    assert plant.motor("FAN-A2").bus == "MCC-A"
    assert plant.bus_of("FAN-A2") is plant.buses[0]
    assert plant.motor("MILL-A3").bus is None
    assert plant.bus_of("MILL-A3") is None


def test_the_scd_says_which_motors_share_a_bus_and_the_motors_file_wins(motors: Path, tmp_path: Path) -> None:
    scd = scd_with_a_busbar(tmp_path)
    assert read_plant(settings(motors, scd)).buses == (Bus(BUSBAR, ("PUMP-A1", "FAN-A2")),)
    text = motors.read_text(encoding="utf-8").replace('name = "FAN-A2"', 'name = "FAN-A2"\nbus = "SPARE"')
    motors.write_text(f'{text}\n[[bus]]\nname = "{BUSBAR}"\nschedule = "5 * * * *"\n')
    assert read_plant(settings(motors, scd)).buses == (
        Bus(BUSBAR, ("PUMP-A1",), Schedule("5 * * * *")),
        Bus("SPARE", ("FAN-A2",)),
    )


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('name = "MCC-A"\n', r"bus MCC-A: expected a bus of the SCD.*\(none is known\), found a bus without"),
        ("schedule = 3\n", "bus 1: name: expected the bus's name, found None"),
        ('name = "B"\nschedule = "at dawn"\n', "bus B: schedule: expected 5 fields"),
        ('name = "B"\ncommon_voltage_transformer = 1\n', "bus B: common_voltage_transformer: expected true"),
        ('name = "B"\nmotors = []\n', "bus B: motors: expected one of name, schedule"),
        ('name = "B"\n[[bus]]\nname = "B"\n', "bus 2: name: expected each bus once, found B again"),
    ],
)
def test_what_is_wrong_in_a_bus_is_named(motors: Path, table: str, message: str) -> None:
    motors.write_text(motors.read_text(encoding="utf-8") + "\n[[bus]]\n" + table)
    with pytest.raises(PlantError, match=message):
        read_plant(settings(motors))


def test_sensors_are_those_of_the_file_or_typical_of_the_relay(motors: Path, tmp_path: Path) -> None:
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    scd = tmp_path / "plant.scd"
    scd.write_text(
        text.replace('manufacturer="SEL"', 'manufacturer="Siemens AG"').replace(
            'type="SEL_710"', 'type="7SK806"'
        ),
        encoding="utf-8",
    )
    named = motors.read_text(encoding="utf-8").replace(
        "[motor.nameplate]", "[motor.sensors]\nvoltage_gain = 0.002\n\n[motor.nameplate]", 1
    )
    motors.write_text(named)
    plant = read_plant(settings(motors, scd))
    assert plant.motor("PUMP-A1").motor.sensors == SensorClass(voltage_gain=0.002, current_gain=0.015)
    assert plant.motor("FAN-A2").motor.sensors == SensorClass(current_gain=0.015)
    usual = read_plant(settings(motors))
    assert usual.motor("FAN-A2").motor.sensors == SensorClass()
