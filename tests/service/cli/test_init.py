"""`mcc init`: a commented plant to fill in, from an SCD, CIDs, addresses, or nothing."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import scl
from core.machines.stator_winding import StatorWinding, WindingKind
from scl import Address
from service.cli.app import main
from service.configuration.settings import Settings
from service.plant import read_plant
from testing.relays.simulated import IED, scenario_of, simulated

VALUES = {
    "rated_power_W": "4000",
    "rated_voltage_V": "400",
    "rated_frequency_Hz": "50",
    "pole_pairs": "2",
    "host": '"10.0.0.9"',
}


def fill_in(motors: Path) -> None:
    """Do what the file asks of a person: a value for each line that ends with =."""
    text = motors.read_text(encoding="utf-8")
    for key, value in VALUES.items():
        text = re.sub(rf"^# {key} =(?=\s+#|$)", f"{key} = {value}", text, flags=re.MULTILINE)
    motors.write_text(text, encoding="utf-8")


def cid(path: Path, name: str, address: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    scl.instantiate(scl.SEL710_ICD, path, name, Address(address))
    return path


def initialise(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, list[str]]:
    assert main(["init", *map(str, arguments), "--json"]) == 0
    document: dict[str, list[str]] = json.loads(capsys.readouterr().out)
    return document


def test_from_an_scd(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plant = tmp_path / "plant"
    document = initialise(capsys, plant, scl.DEMO_PLANT_SCD)
    assert len(document["relays"]) == 6
    fields = [line.split(": ")[3] for line in document["to_fill_in"]]
    assert sorted(set(fields)) == [
        "[nameplate] pole_pairs",
        "[nameplate] rated_frequency_Hz",
        "[nameplate] rated_power_W",
        "[nameplate] rated_voltage_V",
    ]
    assert len(fields) == 24
    assert main(["check", "--config", str(plant / "mcc.toml")]) == 1, "blanks are errors until filled in"
    told = capsys.readouterr().out.splitlines()[:-1]
    assert sorted(told) == sorted(document["to_fill_in"])
    fill_in(plant / "motors.toml")
    assert main(["check", "--config", str(plant / "mcc.toml")]) == 0
    read = read_plant(Settings.load(plant / "mcc.toml"))
    assert [motor.name for motor in read.motors][:2] == ["PUMP-A1", "FAN-A2"]


def test_the_winding_may_be_filled_in_as_well(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plant = tmp_path / "plant"
    initialise(capsys, plant)
    motors = plant / "motors.toml"
    fill_in(motors)
    text = motors.read_text(encoding="utf-8")
    for key in (r"\[motor.winding\]", "kind", "slots", "layers", "coil_pitch_slots"):
        text = re.sub(rf"^# ({key})", r"\1", text, flags=re.MULTILINE)
    motors.write_text(text, encoding="utf-8")
    (motor,) = read_plant(Settings.load(plant / "mcc.toml")).motors
    assert motor.motor.winding == StatorWinding(WindingKind.LAP, 36, 2, 8)


def test_from_cids(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [
        cid(tmp_path / "from tool" / "one.cid", "R_101", "10.0.0.1"),
        cid(tmp_path / "from tool" / "two.cid", "R_102", "10.0.0.2"),
    ]
    plant = tmp_path / "plant"
    initialise(capsys, plant, *files)
    for file in files:
        file.unlink()
    fill_in(plant / "motors.toml")
    read = read_plant(Settings.load(plant / "mcc.toml"))
    assert [(relay.name, relay.host) for relay in read.relays] == [
        ("R_101", "10.0.0.1"),
        ("R_102", "10.0.0.2"),
    ]
    assert [(motor.name, motor.relay) for motor in read.motors] == [
        ("MOTOR-OF-R_101", "R_101"),
        ("MOTOR-OF-R_102", "R_102"),
    ]


def test_from_an_icd_whose_address_nobody_knows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plant = tmp_path / "plant"
    document = initialise(capsys, plant, scl.SEL710_ICD)
    assert any("relay sel710: host: expected the relay's address" in line for line in document["to_fill_in"])
    fill_in(plant / "motors.toml")
    (relay,) = read_plant(Settings.load(plant / "mcc.toml")).relays
    assert (relay.host, relay.trigger_control) == ("10.0.0.9", "sel710CON/RBGGIO1.SPCSO01")


def test_one_file_that_cannot_be_read_is_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    good = cid(tmp_path / "one.cid", "R_101", "10.0.0.1")
    bad = tmp_path / "two.cid"
    bad.write_text("<SCL", encoding="utf-8")
    document = initialise(capsys, tmp_path / "plant", good, bad)
    assert document["relays"] == ["R_101"]
    assert document["left_out"][0].startswith("two.cid: ")
    assert main(["init", str(tmp_path / "other"), str(bad)]) == 1
    assert "two.cid" in capsys.readouterr().err


def test_a_file_without_a_relay_is_left_out_with_what_its_reader_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = cid(tmp_path / "one.cid", "R_101", "10.0.0.1")
    bad = cid(tmp_path / "two.cid", "R_102", "10.0.0.2")
    bad.write_text(bad.read_text(encoding="utf-8").replace('"R_102"', '"R 102"'), encoding="utf-8")
    document = initialise(capsys, tmp_path / "plant", good, bad)
    (words,) = document["left_out"]
    assert words.startswith("two.cid has no IEDs that can be used; line ")
    assert "R 102" in words
    assert main(["init", str(tmp_path / "other"), str(bad)]) == 1
    assert "expected the SCL file of one relay" in capsys.readouterr().err
    assert not (tmp_path / "other").exists()


def test_from_an_scd_without_addresses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scd = tmp_path / "project.scd"
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    scd.write_text(re.sub(r"<Communication>.*</Communication>", "", text, flags=re.DOTALL), encoding="utf-8")
    initialise(capsys, tmp_path / "plant", scd)
    motors = tmp_path / "plant" / "motors.toml"
    fill_in(motors)
    hosts = (f'host = "10.0.0.{number}"' for number in range(1, 7))
    motors.write_text(re.sub('host = "10.0.0.9"', lambda _: next(hosts), motors.read_text("utf-8")), "utf-8")
    read = read_plant(Settings.load(tmp_path / "plant" / "mcc.toml"))
    assert [(one.name, one.relay) for one in read.motors][:1] == [("PUMP-A1", "A1_SEL710")]
    assert [relay.host for relay in read.relays][:2] == ["10.0.0.1", "10.0.0.2"]


def test_from_an_scd_without_a_substation_section(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scd = tmp_path / "project.scd"
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    scd.write_text(re.sub(r"<Substation.*</Substation>", "", text, flags=re.DOTALL), encoding="utf-8")
    initialise(capsys, tmp_path / "plant", scd)
    fill_in(tmp_path / "plant" / "motors.toml")
    read = read_plant(Settings.load(tmp_path / "plant" / "mcc.toml"))
    assert [(relay.name, relay.port) for relay in read.relays][:2] == [
        ("A1_SEL710", 10210),
        ("A2_SEL710", 10211),
    ]


def test_from_addresses_whose_relays_are_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.cli.plant.check.CLOCK_S", 0.0)
    plant = tmp_path / "plant"
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2")) as served:
        addresses = tmp_path / "addresses.txt"
        addresses.write_text(f"# the pumps\n{served.address}\n{served.address}\n127.0.0.1:1 # off\n")
        document = initialise(capsys, plant, addresses)
        assert document["relays"] == [IED, "R2"]
        fill_in(plant / "motors.toml")
        assert main(["check", "--config", str(plant / "mcc.toml"), "--connect", "--json"]) == 1
        asked = {each["relay"]: each for each in json.loads(capsys.readouterr().out)["asked"]}
    assert asked["R2"]["reachable"] is False
    here = asked[IED]
    assert here["reachable"] is True
    assert here["trigger"] == f"{IED}CON/RBGGIO1.SPCSO01"
    assert here["report_control"] == f"{IED}CFG/LLN0.BR.BRep01"
    assert (here["folder"], here["recordings"]) == ("EVENTS", 0)
    text = (plant / "motors.toml").read_text(encoding="utf-8")
    assert f"# {IED}: trigger: {IED}CON/RBGGIO1.SPCSO01" in text
    assert "# R2: it did not answer: 127.0.0.1:1" in text


def test_from_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    initialise(capsys, tmp_path / "plant")
    fill_in(tmp_path / "plant" / "motors.toml")
    assert main(["check", "--config", str(tmp_path / "plant" / "mcc.toml")]) == 0


def test_nothing_is_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motors = tmp_path / "plant" / "motors.toml"
    motors.parent.mkdir()
    motors.write_text("mine")
    assert main(["init", str(motors.parent), str(scl.DEMO_PLANT_SCD)]) == 1
    assert f"found {motors}" in capsys.readouterr().err
    assert motors.read_text() == "mine"
    assert list(motors.parent.iterdir()) == [motors], "nothing else is written either"


@pytest.mark.parametrize(
    ("sources", "code", "message"),
    [
        (["missing.cid"], 1, "missing.cid"),
        (["10.0.0.300"], 2, "expected a file, or an address such as"),
        (["10.0.0.1:99999"], 2, "expected a file, or an address such as"),
        (["10.0.0.1", str(scl.SEL710_ICD)], 2, "or addresses of relays, found several kinds"),
    ],
)
def test_sources_that_cannot_be_used(
    tmp_path: Path, sources: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["init", str(tmp_path / "plant"), *sources]) == code
    assert message in capsys.readouterr().err
    assert not (tmp_path / "plant").exists()


@pytest.mark.parametrize(
    ("content", "found"),
    [(b'[[relay]]\nname = "R1"\n', "found '[[relay]]'"), (b"PK\x03\xff", "another kind")],
)
def test_a_file_of_another_kind_is_named(
    tmp_path: Path, content: bytes, found: str, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "relays.toml"
    source.write_bytes(content)
    assert main(["init", str(tmp_path / "plant"), str(source)]) == 2
    told = capsys.readouterr().err
    assert f"{source}: expected an SCL file, or a list of relays' addresses, one a line" in told
    assert found in told


def test_one_relay_is_counted_as_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = cid(tmp_path / "one.cid", "R_101", "10.0.0.1")
    assert main(["init", str(tmp_path / "plant"), str(source)]) == 0
    assert "\n1 relay; 4 values to fill in: " in capsys.readouterr().out


def test_names_in_a_file_make_no_toml(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    scd = tmp_path / "hostile.scd"
    hostile = "FAN &quot;]&#10;[relays]&#10;x = 1 #"
    scd.write_text(text.replace('name="FAN-A2"', f'name="{hostile}"'), encoding="utf-8")
    initialise(capsys, tmp_path / "plant", scd)
    written = tomllib.loads((tmp_path / "plant" / "motors.toml").read_text(encoding="utf-8"))
    assert written.keys() == {"motor"}
    assert len(written["motor"]) == 6
