"""Relay profiles: how one kind of relay is triggered, reports its records, and offers its files.

A profile is a TOML file with an ICD beside it; docs/reference/simulator.md explains it. Profiles in
`ied_sim/profiles` are chosen by name, any other by its path.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, Self, get_args

from pydantic import Field, ValidationError, model_validator

from core.recordings.comtrade.writer import DataFormat, Revision
from ied_sim.errors import ProfileError
from ied_sim.toml_tables import Table, first_error, read_table
from mms import MOST_CONNECTIONS

SHIPPED = Path(__file__).parent
DEFAULT = "sel-710-ed2"

Text = Literal["HISTORY", "CHISTORY", "SER", "CSER", "LDP", "CLDP", "MSR", "MOT"]
Reference = Annotated[str, Field(pattern=r"^[\w-]+/[\w-]+(\.\w+)+$")]
LogicalNode = Annotated[str, Field(pattern=r"^[\w-]+/[\w-]+$")]
Folder = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+$")]

_FORMAT = re.compile(r"(?:COMTRADE (1991|1999|2013)|CFF) (ASCII|BINARY|BINARY32|FLOAT32)|CEV")
_OF_2013_ONLY = ("BINARY32", "FLOAT32")


@dataclass(frozen=True, slots=True)
class RecordFormat:
    """Format of a record: "COMTRADE" (.CFG, .DAT, .HDR), "CFF" or "CEV".

    COMTRADE and CFF have an edition and a data format.
    """

    kind: Literal["COMTRADE", "CFF", "CEV"]
    revision: Revision = 2013
    data_format: DataFormat = "ASCII"


class Points(Table):
    """References of the relay's model, with the logical device's inst: "CON/RBGGIO1.SPCSO01".

    `trigger`: controls whose rise makes a record. `pulse`: logical nodes whose controls fall by themselves
    after a quarter of a cycle. `start`, `stop`: controls of the motor. `clear`: control that deletes all
    records. `record_made` to `unbalance`: status objects. `metering`: an MMXU. `sequence`: an MSQI.
    `reports`: the buffered report control block that reports records.
    """

    trigger: tuple[Reference, ...] = ()
    pulse: tuple[LogicalNode, ...] = ()
    start: Reference | None = None
    stop: Reference | None = None
    clear: Reference | None = None
    record_made: Reference | None = None
    record_number: Reference | None = None
    record_started: Reference | None = None
    trip: Reference | None = None
    overcurrent: Reference | None = None
    thermal: Reference | None = None
    unbalance: Reference | None = None
    metering: LogicalNode | None = None
    sequence: LogicalNode | None = None
    reports: Reference | None = None

    def controls(self) -> Iterator[tuple[str, str]]:
        """Yield key and reference of every control named here."""
        yield from (("trigger", reference) for reference in self.trigger)
        for key in ("start", "stop", "clear"):
            reference = getattr(self, key)
            if reference is not None:
                yield key, reference

    def statuses(self) -> Iterator[tuple[str, str]]:
        """Yield key and reference of every status object named here."""
        keys = ("record_made", "record_number", "record_started")
        for key in (*keys, "trip", "overcurrent", "thermal", "unbalance"):
            reference = getattr(self, key)
            if reference is not None:
                yield key, reference


class Record(Table):
    """What an event record spans, in which formats, and how many are kept."""

    formats: Annotated[tuple[str, ...], Field(min_length=1)]
    sample_rate_Hz: Annotated[float, Field(ge=500, le=100_000)] | None = None
    samples_per_cycle: Annotated[int, Field(ge=4, le=1000, multiple_of=4)] | None = None
    cycles: Annotated[float, Field(gt=0, le=1800)]
    pre_trigger_cycles: Annotated[float, Field(ge=0)]
    capacity: Annotated[int, Field(ge=1, le=10_000)]

    @model_validator(mode="after")
    def _is_one_record(self) -> Self:
        if (self.sample_rate_Hz is None) == (self.samples_per_cycle is None):
            raise ValueError("give either sample_rate_Hz or samples_per_cycle")
        if self.pre_trigger_cycles >= self.cycles:
            raise ValueError("pre_trigger_cycles must be less than cycles")
        kinds = [written.kind for written in self.written()]
        if len(set(kinds)) != len(kinds):
            raise ValueError("formats may have one each of COMTRADE, CFF and CEV: they share their names")
        return self

    def written(self) -> tuple[RecordFormat, ...]:
        """Return the formats in which every record is written."""
        return tuple(_record_format(text) for text in self.formats)


class Files(Table):
    """The file service: folder and names of the records, and which text reports are offered.

    `separator` and `listed` say how names stand in listings: with "/" or a backslash, with their folder
    ("path") or without it ("name"). `entries_per_listing` is the most entries of one answer; the rest follows
    (moreFollows).
    """

    folder: Folder = "EVENTS"
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9_]*$")] = "HR_"
    separator: Literal["/", "\\"] = "/"
    listed: Literal["path", "name"] = "path"
    entries_per_listing: Annotated[int, Field(ge=1)] | None = None
    reports: tuple[Text, ...] = ()
    settings: bool = False


class Triggers(Table):
    """What makes a record besides the controls: trips, motor starts, a load above so many rated currents."""

    trip: bool = True
    motor_start: bool = False
    load_above: Annotated[float, Field(gt=0)] | None = None


class Profile(Table):
    """One kind of relay.

    With `files` None there is no file service, and `record` only says how long a capture lasts.
    """

    description: str
    icd: str
    firmware: Annotated[str, Field(pattern=r"^[\x21-\x7e]+$")]
    sessions: Annotated[int, Field(ge=1, le=2 * MOST_CONNECTIONS)] = MOST_CONNECTIONS
    report_buffer_bytes: Annotated[int, Field(ge=500, le=1_000_000)] = 8_192
    dynamic_data_sets: Annotated[int, Field(ge=0, le=100)] = 0
    points: Points
    record: Record
    triggers: Triggers = Triggers()
    files: Files | None = None
    path: Path = Path()

    @property
    def name(self) -> str:
        """Name of the profile: that of its file."""
        return self.path.stem

    @property
    def icd_path(self) -> Path:
        """Path of the ICD beside the profile."""
        return self.path.parent / self.icd


def shipped() -> tuple[str, ...]:
    """Return the names of the profiles that come with the simulator."""
    return tuple(sorted(path.stem for path in SHIPPED.glob("*.toml")))


def read_profile(name: str, *, beside: Path | None = None) -> Profile:
    """Read a shipped profile by its name, or the file of a path, relative to `beside`.

    Raises ProfileError.
    """
    if name in shipped():
        path = SHIPPED / f"{name}.toml"
    elif name.endswith(".toml"):
        path = (beside or Path()) / name
    else:
        known = ", ".join(shipped())
        raise ProfileError(
            beside or "profile", "profile", expected=f"one of {known}, or a .toml file", found=name
        )
    table = read_table(path, ProfileError)
    if "path" in table:
        raise ProfileError(path, "path", expected="no such field", found="one; is the name right?")
    try:
        profile = Profile.model_validate(table | {"path": path})
    except ValidationError as error:
        place = ".".join(str(part) for part in error.errors()[0]["loc"])
        raise first_error(path, place or "file", error, ProfileError) from error
    if not profile.icd_path.is_file():
        raise ProfileError(path, "icd", expected="an ICD file beside the profile", found=profile.icd)
    return profile


def _record_format(text: str) -> RecordFormat:
    found = _FORMAT.fullmatch(text)
    if found is None:
        raise ValueError(
            'formats are "COMTRADE 1991|1999|2013 ASCII|BINARY|BINARY32|FLOAT32", "CFF ASCII|..." or "CEV", '
            f"not {text!r}"
        )
    if text == "CEV":
        return RecordFormat("CEV")
    data_format = next(each for each in get_args(DataFormat) if each == found[2])
    if found[1] is None:
        return RecordFormat("CFF", 2013, data_format)
    revision = next(each for each in get_args(Revision) if str(each) == found[1])
    if revision != 2013 and data_format in _OF_2013_ONLY:
        raise ValueError(f"COMTRADE {revision} has no {data_format}; 2013 has")
    return RecordFormat("COMTRADE", revision, data_format)
