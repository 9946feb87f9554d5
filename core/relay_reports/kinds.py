"""Which report of a relay a text is, where it is not the one that was expected."""

from collections.abc import Callable

from core.relay_reports.clock_times import DateOrder
from core.relay_reports.error import ReportError
from core.relay_reports.load_profile import read_load_profile
from core.relay_reports.motor_statistics import read_motor_statistics
from core.relay_reports.sequence_of_events import read_sequence_of_events

_OTHERS: tuple[tuple[str, Callable[[bytes, DateOrder], object]], ...] = (
    (
        "a sequence of events (SER), which core.relay_reports.read_sequence_of_events reads",
        lambda text, order: read_sequence_of_events(text, date_order=order),
    ),
    (
        "motor statistics (MOT), which core.relay_reports.read_motor_statistics reads",
        lambda text, order: read_motor_statistics(text, date_order=order),
    ),
    (
        "a load profile (LDP), which core.relay_reports.read_load_profile reads",
        lambda text, order: read_load_profile(text, date_order=order),
    ),
)


def other_report(text: bytes, *, date_order: DateOrder = DateOrder.MDY) -> str | None:
    """Return what a text is that is no motor start report.

    Parameters
    ----------
    text : bytes
        The text.
    date_order : DateOrder
        Order of dates.

    Returns
    -------
    str or None
        Which report it is and what reads it, in words; None where no reader takes it.
    """
    for words, reader in _OTHERS:
        try:
            reader(text, date_order)
        except ReportError:
            continue
        return words
    return None
