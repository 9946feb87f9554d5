"""SER.TXT and CSER.TXT: the sequential events recorder, changes of the relay word, newest first."""

from ied_sim.texts.snapshot import DATE_LABELS, RelaySnapshot


def sequence(snapshot: RelaySnapshot) -> bytes:
    """Make SER.TXT."""
    lines = ["#     DATE       TIME          ELEMENT     STATE"]
    lines += [
        f"{place:<5} {snapshot.stamp(change.time_ns)}  {change.bit:<10}  "
        f"{'Asserted' if change.value else 'Deasserted'}"
        for place, change in enumerate(reversed(snapshot.word.changes()), 1)
    ]
    return snapshot.report("SEQUENTIAL EVENTS RECORDER", lines)


def compressed_sequence(snapshot: RelaySnapshot) -> bytes:
    """Make CSER.TXT."""
    rows = (
        [
            str(place),
            *snapshot.date_fields(change.time_ns),
            f'"{change.bit}"',
            '"Asserted"' if change.value else '"Deasserted"',
        ]
        for place, change in enumerate(reversed(snapshot.word.changes()), 1)
    )
    return snapshot.compressed(("REC_NUM", *DATE_LABELS, "ELEMENT", "STATE"), rows)
