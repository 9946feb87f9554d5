"""Names of time zones in the database of the IANA."""

from zoneinfo import ZoneInfo, ZoneInfoNotFoundError, available_timezones

from core.error_words import nearest


def is_time_zone(name: str) -> bool:
    """Tell whether the database has a zone of this name."""
    try:
        ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):  # a name may look like a path, or be a folder
        return False
    return True


def nearest_time_zone(name: str) -> str | None:
    """Return the zone whose name is most like a wrong one; None where none is like it.

    The name of a city alone finds its zone.
    """
    zones = {zone.rpartition("/")[2]: zone for zone in sorted(available_timezones())}
    city = nearest(name.rpartition("/")[2].replace(" ", "_"), zones)
    return nearest(name, available_timezones()) or (None if city is None else zones[city])
