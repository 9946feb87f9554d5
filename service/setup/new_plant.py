"""Writes the files of a new plant: settings, a motors file to fill in, and copies of its SCL files."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

from core.error_words import one_line
from service.configuration.problems import Problem
from service.plant import PlantError
from service.setup.draft import Draft, DraftRelay

SETTINGS, MOTORS, SCL_FOLDER = "mcc.toml", "motors.toml", "scl"

BLANKS = (
    ("rated_power_W", "shaft power in W: 75000 for 75 kW"),
    ("rated_voltage_V", "line to line, in V: 3300 for 3.3 kV"),
    ("rated_frequency_Hz", "50 or 60"),
    ("pole_pairs", "pairs, not poles: 2 for about 1500 rpm at 50 Hz"),
)
"""What a person has to fill in for each motor."""


def write_plant(directory: Path, draft: Draft) -> tuple[Path, ...]:
    """Write the files and return their paths; nothing that is there is written over.

    Raises PlantError for what is there already, OSError.
    """
    copies = {path: directory / SCL_FOLDER / path.name for path in _scl_files(draft)}
    texts = {directory / SETTINGS: settings_text(draft), directory / MOTORS: motors_text(draft)}
    _refuse_what_is_there(directory, [*texts, *copies.values()])
    contents = {copy: path.read_bytes() for path, copy in copies.items()}
    contents |= {path: text.encode() for path, text in texts.items()}
    for path, content in contents.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            file.write(content)
    return tuple(contents)


def settings_text(draft: Draft) -> str:
    """Return the settings of the plant (TOML)."""
    lines = [
        "# The settings of the service; docs/reference/settings.md explains all of them.",
        "# mcc check --config mcc.toml tells what is missing, and mcc serve --config mcc.toml starts it.",
        "",
        f"motors = {_quoted(MOTORS)}",
    ]
    if draft.scd is None:
        lines.append('# scd = "plant.scd"    # an SCD of the plant, where there is one')
    else:
        lines.append(f"scd = {_quoted(f'{SCL_FOLDER}/{draft.scd.name}')}")
    if draft.subnetworks:
        lines += [
            f"# Its subnetworks are {one_line(', '.join(draft.subnetworks))}: name the one of this host.",
            f"# subnetwork = {_quoted(draft.subnetworks[0])}",
        ]
    lines += [
        "",
        'data_directory = "data"    # where the service keeps recordings and its database',
        "# database_url = ...       # another database than an SQLite file there, such as PostgreSQL",
        "",
        "# Until there is a user, only this host may look, and nobody may change anything:",
        "# mcc user add NAME --role SECADM --role ENGINEER --config mcc.toml",
        "# For other hosts: bind_address, tls_certificate and tls_key.",
        'bind_address = "127.0.0.1"',
        "port = 8710",
    ]
    return _checked("\n".join(lines) + "\n")


def motors_text(draft: Draft) -> str:
    """Return the motors file of the plant (TOML), with blanks to fill in."""
    lines = [
        "# The motors of the plant, and their relays; docs/reference/motor-file.md explains every key.",
        "# Fill in each line that ends with '=': take the # away and write the value of the nameplate.",
        "# mcc check --config mcc.toml names what is still missing.",
    ]
    lines += [f"# Left out: {one_line(words)}." for words in draft.left_out]
    relays = draft.relays or (DraftRelay("R1", needs_host=True, motor="MOTOR-1"),)
    for relay in relays:
        lines += ["", *_relay_lines(relay), *_motor_lines(relay)]
    return _checked("\n".join(lines) + "\n")


def _relay_lines(relay: DraftRelay) -> Iterator[str]:
    yield from (f"# {relay.name}: {one_line(words)}" for words in relay.told)
    if relay.in_scd and not relay.needs_host:
        yield f"# [[relay]]    # {relay.name} is in the SCD; this table would add to that"
        yield f"# name = {_quoted(relay.name)}"
        yield from _time_zone_lines()
        yield ""
        return
    yield "[[relay]]"
    yield f"name = {_quoted(relay.name)}"
    if relay.scl is not None:
        yield f"scl = {_quoted(f'{SCL_FOLDER}/{relay.scl.name}')}"
    if relay.host is not None:
        yield f"host = {_quoted(relay.host)}"
    elif relay.needs_host:
        yield "# host ="
    else:
        yield "# host = ...    # where it is not the address of its SCL file"
    if relay.port is not None:
        yield f"port = {relay.port}"
    for key, value in (("site", relay.site), ("manufacturer", relay.manufacturer), ("type", relay.type)):
        if value:
            yield f"{key} = {_quoted(value)}"
    yield from _time_zone_lines()
    yield ""


def _time_zone_lines() -> Iterator[str]:
    yield '# time_zone = "Europe/Berlin"    # where the clock of the relay does not run in UTC'


def _motor_lines(relay: DraftRelay) -> Iterator[str]:
    yield "[[motor]]"
    if relay.by_substation:
        yield f"name = {_quoted(relay.motor)}    # protected by {relay.name}, as the SCD says"
    else:
        remark = "" if relay.has_motor_name else "    # call it as the plant does"
        yield f"name = {_quoted(relay.motor)}{remark}"
        yield f"relay = {_quoted(relay.name)}"
    if relay.description and not relay.in_scd:
        yield f"description = {_quoted(relay.description)}"
    elif not relay.description:
        yield '# description = "what it drives"'
    yield '# schedule = "0 6 * * *"    # recorded when: minute, hour, day, month, day of the week, in UTC'
    yield ""
    yield "[motor.nameplate]"
    yield from (f"# {key} =    # {words}" for key, words in BLANKS if key not in relay.plate)
    for key, value in relay.plate.items():
        yield f"{key} = {_quoted(value) if isinstance(value, str) else value}"
    if "connection" not in relay.plate:
        yield '# connection = "delta"    # "star" is the default'
    yield "# [motor.parameters] may stay away at first: the motor begins with what is typical of its rating."
    yield "# mcc commission or mcc parameters gives its own: docs/how-to/commissioning.md."
    yield "# [motor.transformers] has voltage_ratio and current_ratio, where recordings do not tell them:"
    yield "# docs/reference/motor-file.md."
    yield "# [motor.winding]    # the stator's, from a winder's sheet: docs/how-to/stator-winding.md"
    yield '# kind = "lap"    # or "concentric"'
    yield "# slots = 36    # of the stator"
    yield "# layers = 2    # coil sides in a slot, 1 or 2"
    yield "# coil_pitch_slots = 8    # 8 for a span of 1 to 9; leave it out where it is not known"


def _scl_files(draft: Draft) -> list[Path]:
    """Return the SCL files. Raises PlantError where two of them have one name."""
    files = [relay.scl for relay in draft.relays if relay.scl is not None]
    files += [] if draft.scd is None else [draft.scd]
    names: dict[str, Path] = {}
    for file in files:
        other = names.setdefault(file.name, file)
        if other != file:
            expected = f"files of different names, since {other} has this one too"
            raise PlantError([Problem(str(file), "file", expected, file.name)])
    return files


def _refuse_what_is_there(directory: Path, paths: list[Path]) -> None:
    there = [path for path in paths if path.exists()]
    if there or (directory.exists() and not directory.is_dir()):
        expected = "a folder without the files to be written, since none is written over"
        found = ", ".join(str(path) for path in there) or "a file"
        raise PlantError([Problem(str(directory), "folder", expected, found)])


def _checked(text: str) -> str:
    """Return the text. Raises tomllib.TOMLDecodeError for one that is no TOML, which is a bug here."""
    tomllib.loads(text)
    return text


def _quoted(text: str) -> str:
    """Return a text as a TOML string."""
    return json.dumps(one_line(text), ensure_ascii=False)
