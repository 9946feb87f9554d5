"""Writes what was estimated of a motor into the motors file, and keeps all else of it as it is.

Comments, order and layout stay. What the file says of anything but this motor's parameters must be the same
before and after; otherwise nothing is written.
"""

import os
import re
import shutil
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import unified_diff
from pathlib import Path

import tomlkit
from tomlkit.container import Container
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable, Item, Table

from core.error_words import one_line
from core.machines.parameters import ParametersSource
from service.plant.errors import plant_error

CHANGE = ("deep_bars", "leakage_saturation")
"""Tables of what changes from a start to running."""
WRITTEN = ("parameters", "intervals", *CHANGE)
_HEADER = re.compile(r"\s*\[")
_MOTOR = re.compile(r"\s*\[\[\s*motor\s*\]\]")
_BELOW = re.compile(r"\s*\[{1,2}\s*motor\s*\.")
Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class EstimatedParameters:
    """What is written of a motor: values and 95 % intervals by the names of MachineParameters.

    remarks: comments on values that were not estimated, by name.  origin: what they follow from, in words.
    change: figures of the tables in CHANGE, by table; those that it has not are taken away.
    """

    values: Mapping[str, float]
    intervals: Mapping[str, Interval]
    remarks: Mapping[str, str]
    origin: str
    change: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class MotorsFileEdit:
    """A change of the motors file that is not written yet."""

    path: Path
    before: str
    after: str

    @property
    def backup(self) -> Path:
        """Where the file is kept as it was."""
        return self.path.with_name(f"{self.path.name}.bak")

    def diff(self) -> str:
        """Return the change as a unified diff."""
        lines = unified_diff(
            self.before.splitlines(keepends=True),
            self.after.splitlines(keepends=True),
            str(self.path),
            str(self.path),
            n=2,
        )
        return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)

    def write(self) -> None:
        """Keep the file as it was beside it, and put the new one in its place at once.

        Raises PlantError, and changes nothing, where the file is another by now or cannot be written.
        """
        if _text(self.path) != self.before:
            raise plant_error(
                self.path,
                "file",
                expected="the file as it was read",
                found="one that was changed since",
            )
        try:
            shutil.copy2(self.path, self.backup)
            handle, name = tempfile.mkstemp(prefix=f".{self.path.name}.", dir=self.path.parent)
            partial = Path(name)
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(self.after.encode())
                    file.flush()
                    os.fsync(file.fileno())
                shutil.copymode(self.path, partial)
                partial.replace(self.path)
            finally:
                partial.unlink(missing_ok=True)
        except OSError as error:
            raise plant_error(
                self.path, "file", expected="a file and a folder that can be written to", found=str(error)
            ) from error


def with_parameters(path: Path, motor: str, estimated: EstimatedParameters) -> MotorsFileEdit:
    """Return the change that gives a motor of the file its estimated parameters. Raises PlantError."""
    path = path.resolve()  # a link stays one: its file is replaced
    before = _text(path)
    try:
        after = _with_block_changed(before, motor, estimated)
        if after is None:  # written another way, such as motor = [{name = "..."}]
            document = tomlkit.parse(before)
            _enter(_motor_table(document, motor, path), estimated)
            after = tomlkit.dumps(document)
        _require_nothing_else(before, after, motor, path)
    except (TOMLKitError, ValueError, RecursionError) as error:
        raise plant_error(path, "file", expected="valid TOML in UTF-8", found=str(error)) from error
    return MotorsFileEdit(path, before, after)


def _with_block_changed(text: str, motor: str, estimated: EstimatedParameters) -> str | None:
    """Return the file with the lines of one [[motor]] table changed; None where it has no such lines.

    Only these lines are parsed and written again. The comments before the next table are that one's.
    """
    lines = text.splitlines(keepends=True)
    headers = [number for number, line in enumerate(lines) if _HEADER.match(line)]
    for first in (number for number in headers if _MOTOR.match(lines[number])):
        following = [number for number in headers if number > first and not _BELOW.match(lines[number])]
        for last in (*following, len(lines)):
            block = "".join(lines[first:last])
            if not _is_toml(block):
                continue  # a line of a longer text that only looks like a header
            if _name_in(block) != motor:
                break
            while lines[last - 1].strip() == "" or lines[last - 1].lstrip().startswith("#"):
                last -= 1
            end = "\r\n" if lines[first].endswith("\r\n") else "\n"
            table = tomlkit.parse("".join(lines[first:last]).replace("\r\n", "\n").rstrip("\n") + "\n\n")
            _enter(_motor_table(table, motor, Path()), estimated)
            changed = tomlkit.dumps(table).rstrip("\n") + "\n"
            return "".join(lines[:first]) + changed.replace("\n", end) + "".join(lines[last:])
    return None


def _is_toml(text: str) -> bool:
    try:
        tomllib.loads(text)
    except ValueError:
        return False
    return True


def _name_in(block: str) -> object:
    tables = tomllib.loads(block)["motor"]
    return tables[0].get("name") if isinstance(tables, list) and isinstance(tables[0], dict) else None


def _text(path: Path) -> str:
    """Return the file with its line ends as they are. Raises PlantError."""
    try:
        return path.read_bytes().decode()
    except (OSError, UnicodeDecodeError) as error:
        raise plant_error(path, "file", expected="a readable file in UTF-8", found=str(error)) from error


def _motor_table(document: Container, motor: str, path: Path) -> Table | InlineTable:
    tables = document.get("motor", [])
    for table in tables if isinstance(tables, list) else []:
        if isinstance(table, Table | InlineTable) and table.get("name") == motor:
            return table
    raise plant_error(path, f"motor {motor}", expected="its [[motor]] table", found="none")


def _enter(table: Table | InlineTable, estimated: EstimatedParameters) -> None:
    """Enter the parameters, and take away the intervals of those that were not estimated."""
    parameters = _subtable(table, "parameters")
    parameters["source"] = str(ParametersSource.COMMISSIONED)
    for name, value in estimated.values.items():
        parameters[name] = _rounded(value)
    if isinstance(parameters, Table):
        for name, remark in {**estimated.remarks, "source": estimated.origin}.items():
            entry = parameters.item(name)
            if isinstance(entry, Item) and (name == "source" or not entry.trivia.comment):
                entry.comment(one_line(remark))
    for key in CHANGE:
        if key not in estimated.change:
            table.pop(key, None)
            continue
        changing = _subtable(table, key)
        for name, value in estimated.change[key].items():
            changing[name] = _rounded(value)
    if not estimated.intervals:
        table.pop("intervals", None)
        return
    intervals = _subtable(table, "intervals")
    for name in [name for name in intervals if name not in estimated.intervals]:
        del intervals[name]
    for name, ends in estimated.intervals.items():
        intervals[name] = [_rounded(end) for end in ends]


def _subtable(table: Table | InlineTable, key: str) -> Table | InlineTable:
    """Return a table below another, made where there is none."""
    present: Item | None = table.get(key)
    if isinstance(present, Table | InlineTable):
        return present
    table[key] = tomlkit.inline_table() if isinstance(table, InlineTable) else tomlkit.table()
    made = table[key]
    if not isinstance(made, Table | InlineTable):
        raise TypeError(f"expected a table, found {type(made).__name__}")
    return made


def _require_nothing_else(before: str, after: str, motor: str, path: Path) -> None:
    """Raise PlantError where more than the motor's parameters would change."""
    if _without_estimates(before, motor) != _without_estimates(after, motor):
        raise plant_error(
            path,
            f"motor {motor}",
            expected="a layout in which its parameters can be entered and nothing else changes; "
            "write them into it by hand",
            found="another",
        )


def _without_estimates(text: str, motor: str) -> dict[str, object]:
    document: dict[str, object] = tomllib.loads(text)
    tables = document.get("motor")
    for table in tables if isinstance(tables, list) else []:
        if isinstance(table, dict) and table.get("name") == motor:
            for key in WRITTEN:
                table.pop(key, None)
    return document


def _rounded(value: float) -> float:
    return float(f"{value:.7g}")
