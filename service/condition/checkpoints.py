"""Which states of a motor are kept, so that a record that comes late does not make all be folded again.

They are spaced geometrically: a record that is so many records late makes at most sixteen times as many be
folded again, and ten years of hourly records keep about ten states.
"""

RATIO = 8


def is_kept(at: int, records: int) -> bool:
    """Tell whether the state after so many records is kept once there are `records`.

    What is kept of a larger number was kept of every smaller one before: nothing is ever missed.
    """
    if at == records:
        return True
    spacing = 1
    while at % (spacing * RATIO) == 0:
        spacing *= RATIO
    return records - at <= 2 * spacing
