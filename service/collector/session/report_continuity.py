"""Detects lost reports, from their sequence numbers and from the relay's own count of its records.

No record is lost with a report, because the directory is scanned after every report. The figure says how far
a relay's reports can be relied upon.
"""

from mms import Report, ReportMember

SEQUENCE_NUMBERS = 65_536
"""A report's sequence number has 16 bits (IEC 61850-7-2, SqNum) and begins again after the last."""


class ReportContinuity:
    """Follows the reports of one control block over one connection after the other.

    fault_number: reference of the relay's count of records (FltNum), where it has one.
    """

    def __init__(self, fault_number: str | None) -> None:
        self._fault_number = fault_number
        self._sequence_number: int | None = None
        self._records: int | None = None

    def begin(self) -> None:
        """Begin a new connection: some relays begin to count their reports anew."""
        self._sequence_number = None

    def missed_before(self, report: Report) -> str | None:
        """Return what was missed before this report, in words; None when nothing was."""
        reasons = []
        expected, found = self._sequence_number, report.sequence_number
        if found is not None:
            # A report in parts has the same number in each.
            if expected is not None and found not in (expected, (expected + 1) % SEQUENCE_NUMBERS):
                reasons.append(f"report {found} came after {expected}")
            self._sequence_number = found
        for member in report.members:
            if self._fault_number is None or member.reference is None:
                continue
            records = status_of(member)
            if is_of(member.reference, self._fault_number) and isinstance(records, int):
                if self._records is not None and records not in (self._records, self._records + 1):
                    reasons.append(f"the relay's record {records} came after {self._records}")
                self._records = records
        return "; ".join(reasons) or None


def is_of(member: str, reference: str) -> bool:
    """Return whether a report's member belongs to a data object.

    A relay names its members as MMS does: LD/LN$FC$DO, with $attribute where one is reported alone.
    """
    node, _, names = member.partition("$")
    return f"{node}.{names.partition('$')[2]}.".replace("$", ".").startswith(f"{reference}.")


def status_of(member: ReportMember) -> object:
    """Return the status value of a member that is reported alone or with quality and time."""
    return member.value[0] if isinstance(member.value, tuple) and member.value else member.value
