"""HISTORY.TXT and CHISTORY.TXT: the stored event reports, newest first."""

from ied_sim.texts.snapshot import DATE_LABELS, RelaySnapshot


def history(snapshot: RelaySnapshot) -> bytes:
    """Make HISTORY.TXT."""
    lines = [" #     RECORD  DATE       TIME          EVENT          CURRENT(A)  FREQ(Hz)  TARGETS"]
    lines += [
        f"{place:>2}  {event.number:>9}  {snapshot.stamp(event.time_ns)}  {event.kind:<13}  "
        f"{event.metering.current_A:>10.2f}  {event.metering.frequency_Hz:>8.2f}  {event.targets}"
        for place, event in enumerate(snapshot.journal.events(), 1)
    ]
    if len(lines) == 1:
        lines = ["History Buffer Empty"]
    return snapshot.report("EVENT HISTORY", lines)


def compressed_history(snapshot: RelaySnapshot) -> bytes:
    """Make CHISTORY.TXT."""
    labels = ("REC_NUM", "REF_NUM", *DATE_LABELS, "EVENT", "CURRENT", "FREQ", "TARGETS")
    rows = (
        [
            str(place),
            str(event.number),
            *snapshot.date_fields(event.time_ns),
            f'"{event.kind}"',
            f"{event.metering.current_A:.2f}",
            f"{event.metering.frequency_Hz:.2f}",
            f'"{event.targets}"',
        ]
        for place, event in enumerate(snapshot.journal.events(), 1)
    )
    return snapshot.compressed(labels, rows)
