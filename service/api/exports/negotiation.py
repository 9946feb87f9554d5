"""Which format a client wants, by `format` in the query or by the header Accept."""

from collections.abc import Sequence

JSON = "application/json"


def preferred(accept: str | None, offered: Sequence[str]) -> str:
    """Return the media type that a client likes best (RFC 9110, 12.5.1); the first one where it likes none.

    Of those that it likes equally the first is taken. What is not written as the standard says counts for
    nothing.
    """
    ranges = [one for one in map(_range, (accept or "*/*").split(",")) if one is not None]
    return max(offered, key=lambda media_type: (_quality(media_type, ranges), -offered.index(media_type)))


def _range(text: str) -> tuple[str, float] | None:
    name, *parameters = (part.strip().lower() for part in text.split(";"))
    if name.count("/") != 1:
        return None
    quality = 1.0
    for parameter in parameters:
        if parameter.startswith("q="):
            number = parameter.removeprefix("q=")
            if not number.replace(".", "", 1).isdecimal() or len(number) > 5:
                return None
            quality = float(number)
    return name, quality


def _quality(media_type: str, ranges: Sequence[tuple[str, float]]) -> float:
    """Return how much a client likes a media type: what it says most exactly counts."""
    kind = media_type.partition("/")[0]
    for name in (media_type, f"{kind}/*", "*/*"):
        found = [quality for one, quality in ranges if one == name]
        if found:
            return max(found)
    return 0.0
