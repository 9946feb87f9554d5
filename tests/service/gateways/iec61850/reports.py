"""A client of open61850 that is told of a motor by one of its buffered report control blocks."""

import math
import queue
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from open61850 import data as open_data
from open61850 import mms as open_mms
from open61850.mms import rcb as open_rcb

from testing.ports import LOOPBACK

LONGEST_WAIT_S = 60
INTERROGATED = open_mms.ReasonCode(general_interrogation=True)
FIELDS = open_mms.OptFlds(
    reason_for_inclusion=True, data_reference=True, buffer_overflow=True, entry_id=True, conf_revision=True
)


@dataclass(frozen=True, slots=True)
class Member:
    """A data object in a report. value: as `plain` has it."""

    value: object
    reason: open_mms.ReasonCode


@dataclass(frozen=True, slots=True)
class Told:
    """A report. members: by their names, such as `ZMOT1.EEHealth`."""

    members: Mapping[str, Member]
    entry_id: bytes
    overflow: bool
    revision: int

    @property
    def values(self) -> Mapping[str, object]:
        """What it says, without why."""
        return {name: member.value for name, member in self.members.items()}


class Reports:
    """The reports of a control block that a client has enabled, in their order."""

    def __init__(self) -> None:
        self.messages: queue.SimpleQueue[open_mms.InformationReport] = queue.SimpleQueue()

    def next(self) -> Told:
        """Wait for the next one."""
        report = open_mms.decode_report(self.messages.get(timeout=LONGEST_WAIT_S))
        assert report.entry_id is not None
        assert report.buf_ovfl is not None
        assert report.conf_rev is not None
        members = {}
        for entry in report.entries:
            assert entry.reference is not None
            assert entry.reason is not None
            node, _constraint, name = entry.reference.partition("/")[2].split("$")
            members[f"{node}.{name}"] = Member(plain(entry.value), entry.reason)
        return Told(members, report.entry_id, report.buf_ovfl, report.conf_rev)

    def until(self, member: str) -> Sequence[Told]:
        """Return the reports before the next one that has this member."""
        found = []
        while member not in (told := self.next()).members:
            found.append(told)
        return found

    def pass_interrogation(self) -> None:
        """Read up to the answer to the interrogation: what comes then are changes."""
        while not all(member.reason == INTERROGATED for member in self.next().members.values()):
            pass


@contextmanager
def reports_of(port: int, device: str, *, after: bytes | None = None) -> Iterator[Reports]:
    """Enable the first block of a logical device: from now on, or after the entry that was had last.

    Triggers stay as they are configured: to write others would empty the buffer.
    """
    reports = Reports()
    settings = open_rcb.RcbSettings(
        trg_ops=None,
        opt_flds=FIELDS,
        intg_pd_ms=None,
        resv_tms=None,
        entry_id=after,
        general_interrogation=after is None,
    )
    with open_mms.MmsClient.connect(
        LOOPBACK, port=port, on_information_report=reports.messages.put
    ) as client:
        open_rcb.enable(client, open_mms.ObjectName("LLN0$BR$brcbVerdict01", device), settings)
        if after is None:
            reports.pass_interrogation()
        yield reports


def plain(value: object) -> object:
    """A value in Python's own words: structures as tuples, bit strings as octets, None for no number."""
    if isinstance(value, open_data.StructureData):
        return tuple(plain(one) for one in value.members)
    if isinstance(value, open_data.FloatData):
        return None if math.isnan(value.value) else round(value.value, 4)
    assert isinstance(
        value, open_data.BoolData | open_data.IntData | open_data.BitStringData | open_data.TimestampData
    )
    return value.value
