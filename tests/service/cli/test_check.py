"""`mcc check`: everything that is wrong, at once, and what the relays offer."""

import json
from pathlib import Path

import pytest

import scl
from mms import mbed_tls_version
from service.cli.app import main
from tests.service.plant.test_relay_tables import DEMO_MOTORS

MOTORS = """
[[relay]]
name = "R-1"
host = "127.0.0.1"
port = 1

[[motor]]
name = "P-1"
relay = "R-1"

[motor.nameplate]
rated_power_W = 4000
rated_voltage_V = 400
rated_frequency_Hz = 50
pole_pairs = 2
"""


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """The settings of a plant of one motor, whose relay is switched off."""
    (tmp_path / "motors.toml").write_text(MOTORS, encoding="utf-8")
    path = tmp_path / "mcc.toml"
    path.write_text('motors = "motors.toml"\nconnect_timeout_s = 0.5\n', encoding="utf-8")
    return path


def test_a_plant_with_nothing_wrong(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--config", str(config)]) == 0
    note, tls, summary = capsys.readouterr().out.splitlines()
    assert tls == f"TLS to relays: Mbed TLS {mbed_tls_version()}"
    assert summary == "nothing is wrong: 1 motor, 1 relay, 1 site"
    assert note.startswith("note: stator winding not given: P-1: ")
    assert main(["check", "--config", str(config), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    typical = {"kinds": ["concentric", "lap"], "layers": [1], "slots": [24, 36]}
    assert document == {
        "problems": [],
        "warnings": [],
        "motors": ["P-1"],
        "windings": [{"motor": "P-1", "winding": None, "typical": typical}],
        "relays": ["R-1"],
        "mbed_tls": mbed_tls_version(),
        "asked": [],
    }
    assert sorted(file.name for file in config.parent.iterdir()) == ["mcc.toml", "motors.toml"]


def test_a_winding_that_is_given_needs_no_note(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motors = config.with_name("motors.toml")
    given = '[motor.winding]\nkind = "lap"\nslots = 36\ncoil_pitch_slots = 8\n'
    motors.write_text(MOTORS + given, encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 0
    assert "note: " not in capsys.readouterr().out
    assert main(["check", "--config", str(config), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["windings"]
    assert found["winding"] == {"kind": "lap", "slots": 36, "layers": 2, "coil_pitch_slots": 8}
    assert found["typical"] is None


def test_a_winding_that_cannot_be_is_told_with_its_line(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motors = config.with_name("motors.toml")
    motors.write_text(MOTORS + '[motor.winding]\nkind = "lap"\nslots = 35\n', encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 1
    told = capsys.readouterr().out
    line = motors.read_text(encoding="utf-8").splitlines().index("slots = 35") + 1
    assert f"motors.toml: line {line}: motor P-1: [winding] slots: expected a multiple of 3" in told
    assert "note: " not in told


def test_motors_alike_share_a_note(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    seven = [
        MOTORS.replace("R-1", f"R-{k}").replace("P-1", f"P-{k}").replace("port = 1", f"port = {k}")
        for k in range(1, 8)
    ]
    config.with_name("motors.toml").write_text("".join(seven), encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 0
    note, *_ = capsys.readouterr().out.splitlines()
    assert note.startswith("note: stator winding not given: P-1, P-2, P-3, P-4, P-5 and 2 more: ")
    assert note.endswith("; typical of the rating: concentric or lap, one layer, 24 or 36 slots")


def test_a_library_that_does_not_tell_its_cryptography_is_said_so(
    config: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.cli.plant.check.mbed_tls_version", lambda: None)
    assert main(["check", "--config", str(config)]) == 0
    assert "TLS to relays: Mbed TLS of unknown version\n" in capsys.readouterr().out
    assert main(["check", "--config", str(config), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["mbed_tls"] is None


def test_impedances_that_are_unusual_for_the_rating_are_warned_of(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motors = config.with_name("motors.toml")
    of_a_delta = """
[motor.parameters]
stator_resistance_ohm = 12.6
rotor_resistance_ohm = 12.5
stator_leakage_H = 0.0525
rotor_leakage_H = 0.0525
stator_self_inductance_H = 1.03
inertia_kgm2 = 0.0131
"""
    motors.write_text(motors.read_text(encoding="utf-8") + of_a_delta, encoding="utf-8")
    assert main(["check", "--config", str(config), "--json"]) == 0
    warnings = json.loads(capsys.readouterr().out)["warnings"]
    assert any("motor P-1: stator_resistance_ohm is " in one for one in warnings), warnings
    line = motors.read_text(encoding="utf-8").splitlines().index("[motor.parameters]") + 1
    assert warnings[-1].startswith(
        f"{motors}: line {line}: motor P-1: all impedances are off alike: check connection"
    )
    assert main(["check", "--config", str(config)]) == 0
    summary = capsys.readouterr().out.splitlines()[-1]
    assert summary == f"{len(warnings)} warnings; mcc serve would start: 1 motor, 1 relay, 1 site"


@pytest.mark.parametrize(
    ("power", "voltage", "key", "question"),
    [
        ("90", "400", "rated_power_W", "is it in kW? Write it in W (90000 for 90 kW)"),
        ("355", "400", "rated_power_W", "is it in kW?"),
        ("20000", "11000", "rated_power_W", "is it in kW, or rated_voltage_V wrong?"),
        ("90000", "40000", "rated_voltage_V", "is there a digit too many?"),
    ],
)
def test_a_rating_that_is_unusual_is_asked_about_at_its_line(
    config: Path, power: str, voltage: str, key: str, question: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """With nothing but a nameplate, no impedance tells that the power is in kW."""
    motors = config.with_name("motors.toml")
    text = MOTORS.replace("= 4000", f"= {power}").replace("_V = 400", f"_V = {voltage}")
    motors.write_text(text, encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 0
    warning, *_, summary = capsys.readouterr().out.splitlines()
    line = next(number for number, words in enumerate(text.splitlines(), 1) if words.startswith(key))
    assert warning.startswith(f"warning: {motors}: line {line}: motor P-1: {key} = ")
    assert question in warning
    assert "nothing is wrong" not in summary
    assert "mcc serve would start: 1 motor" in summary


def test_a_power_that_no_motor_of_the_voltage_has_is_an_error(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = MOTORS.replace("= 4000", "= 450").replace("_V = 400", "_V = 3300")
    config.with_name("motors.toml").write_text(text, encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 1
    told = capsys.readouterr().out
    assert "[nameplate] rated_power_W: expected 2860 to " in told
    assert "rated_power_W = 450000, for kW were given in place of W" in told


def test_everything_that_is_wrong_is_told_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = DEMO_MOTORS.read_text(encoding="utf-8")
    for old, new in (
        ("rotor_leakage_H = 0.0328", "rotor_leackage_H = 0.0328"),
        ('name = "FAN-A2"\n', 'name = "FAN-A2"\nshedule = "30 6 * * *"\n'),
        ("rated_voltage_V = 400", "rated_voltage_V = 0.4"),
        ('name = "MILL-A3"', 'name = "PUMP-B3"'),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / "motors.toml").write_text(text, encoding="utf-8")
    (tmp_path / "plant.scd").write_bytes(scl.DEMO_PLANT_SCD.read_bytes())
    (tmp_path / "mcc.toml").write_text(
        'scd = "plant.scd"\nmotors = "motors.toml"\nwrokers = 2\ndatabase_url = "nothing"\n'
        'data_directory = "motors.toml"\n\n[relays.A1]\npassword_file = "none"\n',
        encoding="utf-8",
    )
    monkeypatch.setenv("MCC_WROKERS", "4")
    assert main(["check", "--config", str(tmp_path / "mcc.toml"), "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    found = {(problem["field"], problem["nearest"]) for problem in document["problems"]}
    assert found == {
        ("MCC_WROKERS", "MCC_WORKERS"),
        ("wrokers", "workers"),
        ("database_url", None),
        ("data_directory", None),
        ("recordings_directory", None),
        ("relays.A1", None),
        ("motor 6: name", None),
        ("motor MILL-A3", None),
        ("motor PUMP-A1: [parameters] rotor_leackage_H", "rotor_leakage_H"),
        (
            "motor FAN-A2: [nameplate] rated_voltage_V",
            "rated_voltage_V = 400, for kV were given in place of V",
        ),
        ("motor FAN-A2: shedule", "schedule"),
    }
    lines = text.splitlines()
    for problem in document["problems"]:
        if problem["line"] is not None and problem["source"].endswith("motors.toml"):
            key = problem["field"].split()[-1]
            assert key in lines[problem["line"] - 1], problem
    assert main(["check", "--config", str(tmp_path / "mcc.toml")]) == 1
    told = capsys.readouterr().out.splitlines()
    assert sorted(told[:-1]) == sorted(problem["message"] for problem in document["problems"])
    assert told[-1] == "11 problems: mcc serve would not start"


def test_serve_refuses_with_the_same_texts(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motors = config.with_name("motors.toml")
    motors.write_text(MOTORS.replace("port = 1", "port = 0").replace("400\n", "0.4\n"), encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 1
    *told, _ = capsys.readouterr().out.splitlines()
    assert len(told) == 2
    assert main(["serve", "--config", str(config)]) == 1
    refused = [line for line in capsys.readouterr().err.splitlines() if line.startswith("mcc: ")]
    assert sorted(refused) == sorted(f"mcc: {line}" for line in told)


def test_impedances_that_no_motor_of_the_rating_has(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    parameters = """
[motor.parameters]
stator_resistance_ohm = 0.0001
rotor_resistance_ohm = 1.4
stator_leakage_H = 0.0058
rotor_leakage_H = 0.0058
stator_self_inductance_H = 0.115
inertia_kgm2 = 90000
"""
    config.with_name("motors.toml").write_text(MOTORS + parameters, encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 1
    *told, _ = capsys.readouterr().out.splitlines()
    assert ["stator_resistance_ohm: expected 0.02 to 20 ohm" in told[0], "inertia_kgm2" in told[1]] == [
        True
    ] * 2


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("mcc.toml", b"motors = ", "mcc.toml: file: expected valid TOML in UTF-8"),
        ("mcc.toml", b"\xff\xfe", "mcc.toml: file: expected valid TOML in UTF-8"),
        ("motors.toml", b"\xff\xfe", "motors.toml: file: expected valid TOML in UTF-8"),
        ("motors.toml", None, "motors.toml: file: expected a TOML file with [[motor]] tables, found no file"),
        ("mcc.toml", b'motors = "motors.toml"\nscd = "motors.toml"', "motors.toml: line 2: file: expected"),
    ],
)
def test_files_that_cannot_be_read(
    config: Path, name: str, content: bytes | None, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = config.with_name(name)
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    assert main(["check", "--config", str(config)]) == 1
    assert message in capsys.readouterr().out


def test_credentials_that_cannot_be_used(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    secret = config.with_name("secret")
    with config.open("a", encoding="utf-8") as settings:
        settings.write('[relays.R-1]\npassword_file = "secret"\n')
    assert main(["check", "--config", str(config)]) == 1
    assert f"{secret}: relays.R-1: expected " in capsys.readouterr().out
    secret.write_text("hidden word\n", encoding="ascii")
    secret.chmod(0o644)
    assert main(["check", "--config", str(config)]) == 1, "others may read it"
    secret.chmod(0o600)
    assert main(["check", "--config", str(config)]) == 0
    told = capsys.readouterr().out
    assert "warning: relay R-1: its password goes over the network in clear" in told
    assert "hidden" not in told


def test_without_settings_it_says_how_they_are_given(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("MCC_MOTORS", raising=False)
    assert main(["check"]) == 1
    told = capsys.readouterr().out
    assert "in the settings that --config FILE names or as MCC_MOTORS in the environment" in told


def test_a_relay_that_does_not_answer(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--config", str(config), "--connect", "--json"]) == 1
    (asked,) = json.loads(capsys.readouterr().out)["asked"]
    assert (asked["relay"], asked["reachable"]) == ("R-1", False)
    assert asked["reason"]
    assert main(["check", "--config", str(config), "--connect"]) == 1
    told = capsys.readouterr()
    assert told.out.splitlines()[0].startswith("R-1 at 127.0.0.1:1: does not answer: ")
    assert "1 of 1 relay did not answer" in told.out
    assert "nothing is wrong in the files: 1 motor" in told.out
    assert told.err == "", "the progress bar is for terminals"


def test_what_is_left_out_of_a_relay_s_file_is_a_warning(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The relay has a trigger of its own type, and one odd data object: the plant is none the worse."""
    icd = scl.SEL710_ICD.read_text(encoding="utf-8")
    odd = icd.replace(
        "<LNodeType ",
        '<LNodeType id="Odd" lnClass="GGIO"><DO name="Ind1" type="gone"/></LNodeType><LNodeType ',
        1,
    )
    odd = odd.replace("</LDevice>", '<LN lnClass="GGIO" inst="9" lnType="Odd"/></LDevice>', 1)
    (config.parent / "R-1.icd").write_text(odd, encoding="utf-8")
    motors = config.parent / "motors.toml"
    text = motors.read_text(encoding="utf-8")
    motors.write_text(text.replace('name = "R-1"', 'name = "R-1"\nscl = "R-1.icd"'), encoding="utf-8")
    assert main(["check", "--config", str(config)]) == 0
    told = capsys.readouterr().out
    assert "warning: R-1.icd: line " in told
    assert '<DO name="Ind1" type="gone">: left out: expected a DOType with id="gone"' in told
    assert "warning; mcc serve would start: 1 motor," in told


@pytest.mark.usefixtures("new_clients")
@pytest.mark.parametrize(
    ("endpoint", "told"),
    [
        ("https://minio.example:9000", None),
        ("http://127.0.0.1:9000", None),
        ("http://minio.example:9000", "recordings go over the network in clear to http://minio.example:9000"),
        (
            "https://me:geheim@minio.example:9000",
            "expected a URL such as https://minio.example:9000, without",
        ),
    ],
)
def test_the_way_to_an_s3_compatible_store_is_looked_at(
    config: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    endpoint: str,
    told: str | None,
) -> None:
    config.write_text(config.read_text() + 'recordings_url = "s3://statorwatch/plant-1"\n', encoding="utf-8")
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "plant-1")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "geheim")
    monkeypatch.setenv("AWS_ENDPOINT_URL_S3", endpoint)
    assert main(["check", "--config", str(config)]) == 0
    assert main(["check", "--config", str(config), "--json"]) == 0
    said = capsys.readouterr()
    warnings = [line for line in said.out.splitlines() if line.startswith("warning: ")]
    assert len(warnings) == (0 if told is None else 1)
    assert told is None or told in warnings[0]
    assert "geheim" not in said.out + said.err
