"""SER.TXT and CSER.TXT: the sequential events recorder, changes of the relay word, newest first."""

from ied_sim.texts.snapshot import DATE_LABELS, Story


def sequence(story: Story) -> bytes:
    lines = ["#     DATE       TIME          ELEMENT     STATE"]
    lines += [
        f"{place:<5} {story.stamp(change.time_ns)}  {change.bit:<10}  "
        f"{'Asserted' if change.value else 'Deasserted'}"
        for place, change in enumerate(reversed(story.word.changes()), 1)
    ]
    return story.report("SEQUENTIAL EVENTS RECORDER", lines)


def compressed_sequence(story: Story) -> bytes:
    rows = (
        [
            str(place),
            *story.date_fields(change.time_ns),
            f'"{change.bit}"',
            '"Asserted"' if change.value else '"Deasserted"',
        ]
        for place, change in enumerate(reversed(story.word.changes()), 1)
    )
    return story.compressed(("REC_NUM", *DATE_LABELS, "ELEMENT", "STATE"), rows)
