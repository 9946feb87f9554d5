"""A plant from its list of motors, CSV or Excel: what is read, and which row and column a problem names."""

import tomllib
from contextlib import suppress
from pathlib import Path

import pytest
import xlsxwriter
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.machines.parameters import Connection
from service.cli.app import main
from service.configuration.settings import Settings
from service.plant import PlantError, read_plant
from service.setup.motor_list import COLUMNS, draft_of_list, write_list_template
from service.setup.motor_list_file import read_rows

HEADINGS = ("name", "site", "kW", "V", "Hz", "poles", "relay address", "connection", "rpm", "rotor bars")
P1 = ("P-101A", "UNIT-3", 250, 3300, 50, 4, "10.20.1.11", "", 1485, "")
P2 = ("P-101B", "UNIT-4", 7.5, 400, 60, 2, "relay-2:1102", "Delta", "", 28)


def csv_list(path: Path, *rows: tuple[object, ...], separator: str = ",") -> Path:
    path.write_text("\n".join(separator.join(map(str, row)) for row in rows), encoding="utf-8")
    return path


def excel_list(path: Path, *rows: tuple[object, ...]) -> Path:
    with xlsxwriter.Workbook(path) as workbook:
        sheet = workbook.add_worksheet()
        for number, row in enumerate(rows):
            sheet.write_row(number, 0, [cell if cell != "" else None for cell in row])
    return path


@pytest.mark.parametrize("name", ["motors.csv", "motors.xlsx"])
def test_a_list_becomes_a_plant_with_nothing_to_fill_in(name: str, tmp_path: Path) -> None:
    write = excel_list if name.endswith(".xlsx") else csv_list
    listed = write(tmp_path / name, HEADINGS, P1, P2)
    assert main(["init", str(tmp_path / "plant"), str(listed)]) == 0
    assert main(["check", "--config", str(tmp_path / "plant" / "mcc.toml")]) == 0
    plant = read_plant(Settings.load(tmp_path / "plant" / "mcc.toml"))
    first, second = (one.motor.nameplate for one in plant.motors)
    assert [one.name for one in plant.motors] == ["P-101A", "P-101B"]
    assert (first.rated_power_W, first.rated_voltage_V, first.rated_frequency_Hz) == (250e3, 3300.0, 50.0)
    assert (first.pole_pairs, first.connection, first.rated_speed_rpm) == (2, Connection.STAR, 1485.0)
    assert (second.rated_power_W, second.pole_pairs, second.connection) == (7500.0, 1, Connection.DELTA)
    assert second.rotor_bars == 28
    assert [(one.host, one.port) for one in plant.relays] == [("10.20.1.11", 102), ("relay-2", 1102)]
    assert [site.name for site in plant.sites] == ["UNIT-3", "UNIT-4"]


@pytest.mark.parametrize("name", ["motors.csv", "motors.xlsx"])
def test_the_template_has_every_column_and_an_example_that_does_not_count(name: str, tmp_path: Path) -> None:
    template = tmp_path / name
    assert main(["init", "--template", str(template)]) == 0
    rows = read_rows(template)
    assert [cells for _, cells in rows] == [tuple(column.heading for column in COLUMNS)]
    with pytest.raises(
        PlantError, match="row 2: expected a motor in each row below the headings, found no row"
    ):
        draft_of_list(template)
    assert main(["init", "--template", str(template)]) == 1, "it is there"


def test_a_template_of_another_kind_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PlantError, match=r"expected a name that ends with .csv or .xlsx, found motors.ods"):
        write_list_template(tmp_path / "motors.ods")


def test_headings_are_known_by_other_words_and_other_columns_are_named(tmp_path: Path) -> None:
    headings = ("Motor", "Rated power [kW]", "RATED_VOLTAGE_V", "Frequency (Hz)", "Poles", "Maker")
    listed = csv_list(tmp_path / "m.csv", headings, ("P-1", "7,5", "400 V", "50", "4", "X"), separator=";")
    draft = draft_of_list(listed)
    assert draft.left_out == ("column Maker of m.csv is not used",)
    (relay,) = draft.relays
    assert dict(relay.plate) == {
        "rated_power_W": 7500, "rated_voltage_V": 400, "rated_frequency_Hz": 50, "pole_pairs": 2,
    }  # fmt: skip
    assert relay.needs_host
    assert relay.name == "RELAY-P-1"


@pytest.mark.parametrize(
    ("column", "cell", "problem"),
    [
        ("name", "", "row 2, column name: expected the name of the motor, without '/', found nothing"),
        ("name", "P/1", "row 2, column name: expected the name of the motor, without '/', found 'P/1'"),
        ("kW", "seven", "row 2, column kW: expected a number in kW, such as 250, found 'seven'"),
        ("kW", "1,250", "row 2, column kW: .* without a separator of thousands, found '1,250'"),
        ("kW", "250000", "row 2, column kW: expected .* at 3300 V.*, found 250000 kW"),
        ("V", "3.3 kV", "row 2, column V: expected a number in V, such as 3300, found '3.3 kV'"),
        ("Hz", "", "row 2, column Hz: expected rated frequency, found nothing"),
        ("poles", "3", "row 2, column poles: expected an even number, such as 4, found '3'"),
        ("rotor bars", "28.5", "row 2, column rotor bars: expected a whole number, such as 40, found '28.5'"),
        ("connection", "wye", 'row 2, column connection: expected "star" or "delta", found wye'),
        ("rpm", "9999", "row 2, column rpm: expected 1200 to .* rpm, found 9999 rpm"),
        ("relay address", "no host!", "row 2, column relay address: expected an address such as 10.20.1.11"),
        ("relay address", "relay-2:1102", "row 3, column relay address: .* which row 2 has"),
    ],
)  # fmt: skip
def test_a_problem_names_row_and_column(column: str, cell: str, problem: str, tmp_path: Path) -> None:
    wrong = tuple(cell if heading == column else value for heading, value in zip(HEADINGS, P1, strict=True))
    with pytest.raises(PlantError, match=problem):
        draft_of_list(csv_list(tmp_path / "m.csv", HEADINGS, tuple(f'"{one}"' for one in wrong), P2))


def test_all_problems_are_named_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    listed = csv_list(tmp_path / "m.csv", HEADINGS, P1, P1, ("X", "", "?", "?", "?", "?", "", "", "", ""))
    assert main(["init", str(tmp_path / "plant"), str(listed)]) == 1
    assert len(capsys.readouterr().err.splitlines()) == 2 + 4
    assert not (tmp_path / "plant").exists()


def test_a_heading_that_is_missing_or_twice_is_named(tmp_path: Path) -> None:
    missing = csv_list(tmp_path / "m.csv", ("name", "kWs", "V", "Hz", "poles"), ("P", 1, 400, 50, 4))
    with pytest.raises(PlantError, match=r"row 1: expected the heading kW .*did you mean kWs"):
        draft_of_list(missing)
    twice = csv_list(
        tmp_path / "t.csv", ("name", "motor", "kW", "V", "Hz", "poles"), ("P", "Q", 1, 400, 50, 4)
    )
    with pytest.raises(PlantError, match="row 1, column motor: expected name once, found it again"):
        draft_of_list(twice)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no workbook", b"\xff\xfe\x00n", b'name,kW\n"P'])
@pytest.mark.parametrize("name", ["m.csv", "m.xlsx"])
def test_a_file_that_is_no_list_is_refused_in_words(name: str, content: bytes, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(PlantError, match="expected"):
        draft_of_list(tmp_path / name)


@given(st.data())
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_damaged_workbook_is_read_or_refused_in_words(tmp_path: Path, data: st.DataObject) -> None:
    content = bytearray(excel_list(tmp_path / "m.xlsx", HEADINGS, P1).read_bytes())
    for place in data.draw(st.lists(st.integers(0, len(content) - 1), min_size=1, max_size=8)):
        content[place] = data.draw(st.integers(0, 255))
    (tmp_path / "m.xlsx").write_bytes(content)
    with suppress(PlantError):  # which is in words; nothing else leaves it
        assert draft_of_list(tmp_path / "m.xlsx").relays


def test_what_is_written_is_toml_whatever_the_cells_say(tmp_path: Path) -> None:
    hostile = ('P"]\n[x', "site\\", 250, 3300, 50, 4, "", "", "", "")
    listed = excel_list(tmp_path / "m.xlsx", HEADINGS, hostile)
    assert main(["init", str(tmp_path / "plant"), str(listed)]) == 0
    written = tomllib.loads((tmp_path / "plant" / "motors.toml").read_text(encoding="utf-8"))
    assert set(written) == {"relay", "motor"}
