"""A plant by its list of motors: a row for each, with name, nameplate and its relay's address."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from core.error_words import nearest
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import plate_from_table
from service.configuration.problems import Problem, Problems
from service.plant.errors import PlantError
from service.plant.relay_entry import RELAY_NAME
from service.setup.addresses import host_and_port, is_address
from service.setup.draft import MOST_RELAYS, Draft, DraftRelay, free_name
from service.setup.motor_list_file import Row, read_rows, write_template


@dataclass(frozen=True, slots=True)
class ListColumn:
    """A column of the list.

    meaning: in words.  example: in the template.  unit: that a cell may have behind its number.
    other: other headings by which it is known, in small letters and digits alone.
    key: of the nameplate in the motors file.  factor: from the list's unit to that of the file.
    """

    heading: str
    meaning: str
    example: str
    unit: str = ""
    other: str = ""
    key: str | None = None
    factor: float = 1.0

    @property
    def is_required(self) -> bool:
        """Tell whether each row has a cell of it."""
        return self.heading in REQUIRED


COLUMNS: Final = (
    ListColumn("name", "name of the motor, as the plant calls it", "P-101A", other="motor tag id"),
    ListColumn("site", "plant or area where the motor is", "UNIT-3", other="plant area"),
    ListColumn("kW", "rated power at the shaft", "250", unit="kW", key="rated_power_W", factor=1000.0,
               other="power powerkw ratedpower ratedpowerkw"),
    ListColumn("V", "rated voltage, line to line", "3300", unit="V", key="rated_voltage_V",
               other="voltage voltagev ratedvoltage ratedvoltagev"),
    ListColumn("Hz", "rated frequency", "50", unit="Hz", key="rated_frequency_Hz",
               other="frequency frequencyhz ratedfrequency ratedfrequencyhz"),
    ListColumn("poles", "number of poles, not pairs: 4 for about 1500 rpm at 50 Hz", "4",
               key="pole_pairs", factor=0.5, other="numberofpoles"),
    ListColumn("relay address", "IP address or host name of its relay, with :PORT where that is not 102",
               "10.20.1.11", other="address relayip ip ipaddress host relayhost"),
    ListColumn("relay", "name of the relay; one made of the motor's name where it is empty", "P-101A-710",
               other="relayname ied"),
    ListColumn("description", "what the motor drives", "Feed water pump", other="service drives"),
    ListColumn("connection", "star or delta; star where it is empty", "star", key="connection"),
    ListColumn("rpm", "rated speed, from the nameplate", "1485", unit="rpm", key="rated_speed_rpm",
               other="speed ratedspeed speedrpm ratedspeedrpm"),
    ListColumn("rotor bars", "number of bars of the cage", "", key="rotor_bars", other="bars"),
)  # fmt: skip
REQUIRED: Final = ("name", "kW", "V", "Hz", "poles")

_NUMBER = re.compile(r"[+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?")
_THOUSANDS = re.compile(r"[+-]?\d{1,3},\d{3}")
_COUNTS: Final = ("pole_pairs", "rotor_bars")


@dataclass(slots=True)
class _Reading:
    """What was read so far. columns: place of each in a row.  rows: of the names and addresses so far."""

    path: Path
    columns: Mapping[str, int]
    problems: Problems
    rows: dict[tuple[str, str], int] = field(default_factory=dict)

    def refuse(self, row: int, heading: str, expected: str, found: str, meant: str | None = None) -> None:
        place = f"row {row}, column {heading}"
        self.problems.add(Problem(str(self.path), place, expected, found, meant))


def draft_of_list(path: Path) -> Draft:
    """Return the plant of a list of motors. Raises PlantError, which names row and column of each problem."""
    rows = read_rows(path)
    problems = Problems()
    columns, unused = _headings(path, rows, problems)
    if problems:
        raise PlantError(problems)
    reading = _Reading(path, columns, problems)
    relays: list[DraftRelay] = []
    for row in rows[1:]:
        relays.append(_relay(reading, row, relays))
    if not relays:
        problems.add(Problem(str(path), "row 2", "a motor in each row below the headings", "no row"))
    if len(relays) > MOST_RELAYS:
        problems.add(Problem(str(path), "file", f"at most {MOST_RELAYS} motors", str(len(relays))))
    if problems:
        raise PlantError(problems)
    left_out = tuple(f"column {heading} of {path.name} is not used" for heading in unused)
    return Draft(tuple(relays), left_out=left_out)


def write_list_template(path: Path) -> None:
    """Write an empty list of motors, CSV or Excel by its name. Raises PlantError, OSError."""
    meanings = {one.heading: f"{'' if one.is_required else 'optional: '}{one.meaning}" for one in COLUMNS}
    write_template(path, meanings, [one.example for one in COLUMNS])


def _headings(path: Path, rows: Sequence[Row], problems: Problems) -> tuple[dict[str, int], list[str]]:
    """Return where each column is, and headings of columns that are none of ours."""
    number, cells = rows[0] if rows else (1, ())
    found: dict[str, int] = {}
    unused = []
    for place, heading in enumerate(cells):
        column = _column(heading)
        if column is None:
            unused += [heading] if heading else []
        elif column.heading in found:
            place_words = f"row {number}, column {heading}"
            problems.add(Problem(str(path), place_words, f"{column.heading} once", "it again"))
        else:
            found[column.heading] = place
    for column in COLUMNS:
        if column.is_required and column.heading not in found:
            meant = nearest(column.heading, unused)
            there = ", ".join(filter(None, cells)) or "none"
            expected = f"the heading {column.heading} ({column.meaning})"
            problems.add(Problem(str(path), f"row {number}", expected, f"headings {there}", meant))
    return found, unused


def _column(heading: str) -> ListColumn | None:
    """Return the column that a heading is of: "Rated power [kW]", "RATED_VOLTAGE_V"."""
    word = re.sub(r"[^a-z0-9]", "", heading.lower())
    for column in COLUMNS:
        if word in (re.sub(r"[^a-z0-9]", "", column.heading.lower()), *column.other.split()):
            return column
    return None


def _relay(reading: _Reading, row: Row, relays: Sequence[DraftRelay]) -> DraftRelay:
    number, cells = row

    def text(heading: str) -> str:
        place = reading.columns.get(heading)
        return "" if place is None or place >= len(cells) else cells[place]

    name, address, relay = text("name"), text("relay address"), text("relay")
    _check_name(reading, number, name)
    _once(reading, number, "name", name)
    _once(reading, number, "relay address", address)
    _once(reading, number, "relay", relay)
    if relay and not RELAY_NAME.fullmatch(relay):
        expected = "at most 64 letters, digits, '_', '-' or '.', a letter or digit first"
        reading.refuse(number, "relay", expected, repr(relay[:80]))
    host, port = None, None
    if address and is_address(address):
        host, port = host_and_port(address)
    elif address:
        expected = "an address such as 10.20.1.11 or 10.20.1.11:102"
        reading.refuse(number, "relay address", expected, repr(address[:60]))
    return DraftRelay(
        relay or free_name(f"RELAY-{name}", relays),
        host=host,
        port=port,
        needs_host=host is None,
        motor=name,
        description=text("description"),
        site=text("site"),
        has_motor_name=True,
        plate=_plate(reading, number, {one.heading: text(one.heading) for one in COLUMNS if one.key}),
    )


def _check_name(reading: _Reading, row: int, name: str) -> None:
    if not name or "/" in name:
        reading.refuse(row, "name", "the name of the motor, without '/'", repr(name) if name else "nothing")


def _once(reading: _Reading, row: int, heading: str, value: str) -> None:
    """Refuse what an earlier row has in the same column."""
    if not value:
        return
    first = reading.rows.setdefault((heading, value.casefold()), row)
    if first != row:
        reading.refuse(row, heading, "each motor and relay once", f"{value!r}, which row {first} has")


def _plate(reading: _Reading, row: int, cells: Mapping[str, str]) -> dict[str, str | float | int]:
    """Return the nameplate of a row by the keys of the motors file, as far as it is right."""
    plate: dict[str, str | float | int] = {}
    headings: dict[str, str] = {}
    known = len(list(reading.problems))
    for column in COLUMNS:
        if column.key is None:
            continue
        headings[column.key] = column.heading
        cell = cells[column.heading]
        if not cell:
            if column.is_required:
                reading.refuse(row, column.heading, column.meaning, "nothing")
        elif column.key == "connection":
            plate[column.key] = cell.lower()
        else:
            value = _value(reading, row, column, cell)
            if value is not None:
                plate[column.key] = value
    if len(list(reading.problems)) == known:
        _check_plate(reading, row, plate, headings, cells)
    return plate


def _check_plate(
    reading: _Reading,
    row: int,
    plate: Mapping[str, str | float | int],
    headings: Mapping[str, str],
    cells: Mapping[str, str],
) -> None:
    """Refuse figures that no motor has."""
    try:
        plate_from_table({"nameplate": dict(plate)}, name=f"row {row}", source=reading.path)
    except MotorFileError as error:
        for one in (error, *error.others):
            heading = headings.get(one.field.removeprefix("[nameplate] "), one.field)
            unit = next((column.unit for column in COLUMNS if column.heading == heading), "")
            cell = cells.get(heading, one.found).removesuffix(unit).rstrip()
            reading.refuse(row, heading, one.expected, f"{cell} {unit}".rstrip())


def _value(reading: _Reading, row: int, column: ListColumn, cell: str) -> float | int | None:
    """Return the number of a cell in the unit of the motors file, or refuse the cell."""
    text = cell.removesuffix(column.unit).rstrip() if column.unit else cell
    expected = f"a number{f' in {column.unit}' if column.unit else ''}, such as {column.example or 40}"
    if _THOUSANDS.fullmatch(text):
        reading.refuse(row, column.heading, f"{expected}, without a separator of thousands", repr(cell[:40]))
        return None
    if not _NUMBER.fullmatch(text):
        reading.refuse(row, column.heading, expected, repr(cell[:40]))
        return None
    value = float(text.replace(",", ".")) * column.factor
    if column.key in _COUNTS:
        if value != int(value):
            whole = "an even number" if column.factor == 0.5 else "a whole number"
            reading.refuse(row, column.heading, f"{whole}, such as {column.example or 40}", repr(cell[:40]))
            return None
        return int(value)
    return int(value) if value == int(value) else value
