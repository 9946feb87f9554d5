"""Relays that the motors file describes: without an SCD, beside one, and what is wrong with them."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import scl
from scl import Address
from service.configuration.problems import Problems
from service.configuration.settings import Settings
from service.plant import Overrides, Plant, PlantError, Site, acquisition_from_scl, read_plant

Write = Callable[..., Path]

MOTOR = """
[motor.nameplate]
rated_power_W = 4000
rated_voltage_V = 400
rated_frequency_Hz = 50
pole_pairs = 2

[motor.parameters]
stator_resistance_ohm = 1.405
rotor_resistance_ohm = 1.395
stator_leakage_H = 0.005839
rotor_leakage_H = 0.005839
stator_self_inductance_H = 0.1147
inertia_kgm2 = 0.0131
"""

DEMO_MOTORS = Path(__file__).parents[3] / "service" / "demo" / "motors.toml"


def motor(name: str, *lines: str) -> str:
    return "\n".join(("\n[[motor]]", f'name = "{name}"', *lines, MOTOR))


def relay(name: str, *lines: str) -> str:
    return "\n".join(("\n[[relay]]", f'name = "{name}"', *lines, ""))


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Plant]:
    def plant(*tables: str, scd: Path | None = None) -> Plant:
        motors = tmp_path / "motors.toml"
        motors.write_text("\n".join(tables), encoding="utf-8")
        return read_plant(Settings(motors=motors, scd=scd))

    return plant


@pytest.fixture
def cid(tmp_path: Path) -> Path:
    """The CID of one relay, as its engineering tool exports it."""
    path = tmp_path / "feeder.cid"
    scl.instantiate(scl.SEL710_ICD, path, "R1_SEL710", Address("10.0.0.7", 1102))
    return path


def test_a_relay_says_how_its_recordings_are_read(read: Callable[..., Plant]) -> None:
    """The motor that it protects carries it to all that reads them."""
    strict, lenient, said = (f'host = "10.0.0.{k}"' for k in (7, 8, 9))
    plant = read(
        *(motor(f"P-{k}", f'relay = "R-{k}"') for k in (1, 2, 3)),
        relay("R-1", strict),
        relay("R-2", lenient, 'reading = "lenient"'),
        relay("R-3", said, 'reading = "strict"'),
    )
    assert {one.name: one.motor.reads_leniently for one in plant.motors} == {
        "P-1": False,
        "P-2": True,
        "P-3": False,
    }
    with pytest.raises(PlantError, match=r'reading.*"strict" or "lenient".*kind'):
        read(motor("P-1", 'relay = "R-1"'), relay("R-1", strict, 'reading = "kind"'))


@pytest.mark.parametrize(("name", "domain"), [("R-1", "R_1"), ("3UF7", "R3UF7"), ("M.1", "M_1")])
def test_a_relay_of_an_icd_may_have_a_name_that_no_ied_may_have(
    read: Callable[..., Plant], tmp_path: Path, name: str, domain: str
) -> None:
    icd = tmp_path / "relay.icd"
    icd.write_bytes(scl.SEL710_ICD.read_bytes())
    plant = read(
        motor("P-101A", f'relay = "{name}"'),
        relay(name, 'scl = "relay.icd"', 'host = "10.0.0.8"'),
    )
    assert plant.relays[0].name == name
    assert plant.relays[0].trigger_control == f"{domain}CON/RBGGIO1.SPCSO01"


def test_a_plant_without_an_scd(read: Callable[..., Plant], cid: Path) -> None:
    plant = read(
        motor("P-101A", 'relay = "R-1"', 'description = "Feed pump"'),
        motor("P-101B", "[motor.relay]", 'name = "R-2"', 'trigger = "none"'),
        relay("R-1", f'scl = "{cid.name}"', 'time_zone = "Europe/Berlin"', 'site = "BOILER_HOUSE"'),
        relay("R-2", 'host = "10.0.0.8"'),
    )
    first, second = plant.relays
    assert (first.host, first.port, first.time_zone) == ("10.0.0.7", 1102, "Europe/Berlin")
    assert (first.manufacturer, first.trigger_control) == ("SEL", "R1_SEL710CON/RBGGIO1.SPCSO01")
    assert (second.host, second.port, second.time_zone, second.expected) == ("10.0.0.8", 102, None, None)
    assert second.overrides == Overrides(trigger="none")
    assert acquisition_from_scl(second).report_controls == ()
    assert plant.sites == (Site("BOILER_HOUSE", ""), Site("PLANT", ""))
    assert [(one.name, one.relay, one.site, one.description) for one in plant.motors] == [
        ("P-101A", "R-1", "BOILER_HOUSE", "Feed pump"),
        ("P-101B", "R-2", "PLANT", ""),
    ]


def test_the_motors_file_wins_over_the_address_in_a_cid_and_that_is_told(cid: Path) -> None:
    motors = cid.with_name("motors.toml")
    text = motor("M1", 'relay = "R1"') + relay("R1", f'scl = "{cid.name}"', 'host = "pump.plant"')
    motors.write_text(text, encoding="utf-8")
    problems = Problems()
    plant = read_plant(Settings(motors=motors), problems)
    assert (plant.relays[0].host, plant.relays[0].port) == ("pump.plant", 1102)
    assert problems.warnings == [
        "relay R1: its address is pump.plant:1102, as the motors file says, "
        "not 10.0.0.7:1102, as feeder.cid does"
    ]


def test_an_icd_gets_the_name_of_its_relay(read: Callable[..., Plant]) -> None:
    table = relay("R1", f'scl = "{scl.SEL710_ICD}"', 'host = "10.0.0.8"')
    found = read(motor("M1", 'relay = "R1"'), table).relays[0]
    assert (found.port, found.report_control) == (102, "R1CFG/LLN0.BR.BRep01")
    with pytest.raises(PlantError, match=r"relay R1: host: expected the relay's address, which sel710\.icd"):
        read(motor("M1", 'relay = "R1"'), table.replace('host = "10.0.0.8"', ""))


def test_relays_beside_those_of_an_scd(read: Callable[..., Plant]) -> None:
    plant = read(
        DEMO_MOTORS.read_text(encoding="utf-8"),
        motor("P-101A", 'relay = "R-1"'),
        relay("R-1", 'host = "10.0.0.7"', 'site = "FACTORY_B"'),
        relay("A1_SEL710", 'time_zone = "Europe/Rome"', 'host = "10.0.0.1"'),
        scd=scl.DEMO_PLANT_SCD,
    )
    assert [one.name for one in plant.motors][5:] == ["PUMP-B3", "P-101A"]
    assert plant.motor("P-101A").site == "FACTORY_B"
    assert plant.sites[1] == Site("FACTORY_B", "Factory B")
    told = plant.relay("A1_SEL710")
    assert (told.host, told.port, told.time_zone) == ("10.0.0.1", 10210, "Europe/Rome")


def test_an_scd_without_a_substation_section(read: Callable[..., Plant], tmp_path: Path) -> None:
    scd = tmp_path / "project.scd"
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    scd.write_text(re.sub(r"<Substation.*</Substation>", "", text, flags=re.DOTALL), encoding="utf-8")
    plant = read(motor("M1", 'relay = "B3_SEL710"'), scd=scd)
    assert [(one.name, one.port) for one in plant.relays] == [("B3_SEL710", 10215)]
    with pytest.raises(PlantError, match=r"project\.scd: <Substation>: expected motors .*, or a relay for"):
        read(motor("M1"), scd=scd)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        (
            [motor("M1", 'relay = "R1"'), motor("M2", 'relay = "R1"'), relay("R1", 'host = "h"')],
            "relay R1: expected one motor for one relay, which measures the currents of one, found M1 and M2",
        ),
        (
            [motor("M1", 'relay = "R1"'), motor("M2"), relay("R1", 'host = "h"')],
            'motor M2: relay: expected the name of its relay (relay = "NAME" of a [[relay]] table), found',
        ),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'host = "h"'), relay("R2", 'host = "i"')],
            'relay R2: expected a motor that names it (relay = "R2"), found none',
        ),
        (
            [motor("M1", 'relay = "R-101"'), relay("R101", 'host = "h"')],
            "relay: expected the name of a [[relay]] table (R101), found R-101 (did you mean R101?)",
        ),
        ([motor("M1", 'relay = "R1"'), relay("R1")], "relay R1: host: expected the relay's address (host)"),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'host = "10.0.0.300"')],
            "relay R1: host: expected an IP address or a host name, found '10.0.0.300'",
        ),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'host = "h"', "port = 0")],
            "relay R1: port: expected a port from 1 to 65535, found 0",
        ),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'host = "h"', 'time_zone = "Berlin"')],
            'relay R1: time_zone: expected an IANA time zone such as "Europe/Berlin", or "UTC", '
            "found 'Berlin' (did you mean Europe/Berlin?)",
        ),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'hosts = "h"')],
            "relay R1: hosts: expected one of name, scl, site, host, port, time_zone, manufacturer, type, "
            "reading, found an unknown key (did you mean host?)",
        ),
        (
            [motor("M1", 'relay = "R1"'), relay("R1", 'scl = "missing.cid"')],
            "missing.cid",
        ),
        (
            [motor("M1", "relay = 3"), relay("R1", 'host = "h"')],
            "motor M1: relay: expected the name of a relay, or a table, found 3",
        ),
        (
            [motor("M1", 'relay = "R/1"'), relay("R/1", 'host = "h"')],
            "relay R/1: name: expected at most 64 letters, digits",
        ),
        (
            [motor("M/1", 'relay = "R1"'), relay("R1", 'host = "h"')],
            "motor M/1: name: expected a name without '/'",
        ),
        (
            [
                motor("M1", 'relay = "R1"'),
                motor("M2", 'relay = "R2"'),
                relay("R1", 'host = "::1"'),
                relay("R2", 'host = "0:0::1"'),
            ],
            "relays R1 and R2: expected an address for each relay",
        ),
        (["[relay]\nname = 1"], "relay: expected [[relay]] tables, with two brackets, found {'name': 1}"),
    ],
)
def test_what_is_wrong_with_a_relay_is_named(
    read: Callable[..., Plant], tables: list[str], message: str
) -> None:
    with pytest.raises(PlantError) as failure:
        read(*tables)
    assert [line for line in str(failure.value).splitlines() if message in line], str(failure.value)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            relay("A1_SEL710", f'scl = "{scl.SEL710_ICD}"'),
            "relay A1_SEL710: scl: expected no file of its own, since demo_plant.scd has an IED of this name",
        ),
        (relay("A1_SEL711", 'time_zone = "UTC"'), "relay A1_SEL711: expected a motor that names it"),
        (
            motor("M1", 'relay = "A1_SEL710"'),
            "relay A1_SEL710: expected one motor for one relay, which measures the currents of one, "
            "found PUMP-A1 and M1",
        ),
    ],
)
def test_what_contradicts_the_scd_is_named(read: Callable[..., Plant], table: str, message: str) -> None:
    with pytest.raises(PlantError) as failure:
        read(DEMO_MOTORS.read_text(encoding="utf-8"), table, scd=scl.DEMO_PLANT_SCD)
    assert message in str(failure.value)


def test_another_relay_than_the_scd_has_for_a_motor(read: Callable[..., Plant]) -> None:
    text = DEMO_MOTORS.read_text(encoding="utf-8")
    with pytest.raises(PlantError) as failure:
        read(text.replace('name = "FAN-A2"', 'name = "FAN-A2"\nrelay = "A1_SEL710"'), scd=scl.DEMO_PLANT_SCD)
    assert (
        "motor FAN-A2: relay: expected A2_SEL710, as the SCD's Substation section has it, or none, "
        "found A1_SEL710" in str(failure.value)
    )


def test_everything_that_is_wrong_is_told_at_once(read: Callable[..., Plant]) -> None:
    with pytest.raises(PlantError) as failure:
        read(
            motor("M1", 'relay = "R1"', 'schedule = "at dawn"', 'bus = ""'),
            motor("M2", 'relay = "R9"'),
            motor("M2"),
            relay("R1", "port = 0", 'time_zone = "Berlin"'),
        )
    fields = [problem.field for problem in failure.value.problems]
    assert fields == [
        "motor 3: name",
        "motor M1: schedule",
        "motor M1: bus",
        "relay R1: port",
        "relay R1: time_zone",
        "motor M2: relay",
        "relay R1: host",
    ]
