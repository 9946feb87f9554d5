"""The lines of a TOML file at which its tables and keys stand, for messages; tomllib does not tell them."""

import re
from collections.abc import Iterator

Path = tuple[str | int, ...]
"""Keys from the top of the file on; a table of an array of tables is a number from 0."""

_PART = re.compile(r"""\s*(?:"((?:[^"\\]|\\.)*)"|'([^']*)'|([A-Za-z0-9_-]+))\s*""")
_LONG_TEXTS = ('"""', "'''")


class TomlLines:
    """Finds the line of a key in the text of a file that tomllib has read."""

    def __init__(self, text: str) -> None:
        self._lines: dict[Path, int] = {}
        for path, number in _keys(text):
            self._lines.setdefault(path, number)

    def line(self, *path: str | int) -> int | None:
        """Return the line of a key, or else of the nearest table around it; None at the top of the file."""
        while path:
            if path in self._lines:
                return self._lines[path]
            path = path[:-1]
        return None


def _keys(text: str) -> Iterator[tuple[Path, int]]:
    table: Path = ()
    arrays: dict[Path, int] = {}
    closing: str | None = None
    for number, line in enumerate(text.splitlines(), start=1):
        if closing is not None:
            closing = None if closing in line else closing
            continue
        stripped = line.strip()
        if stripped.startswith("["):
            is_array = stripped.startswith("[[")
            table = _inside(_parts(stripped.lstrip("[")), arrays, begins=is_array)
            yield from ((table[:length], number) for length in range(1, len(table) + 1))
            continue
        parts = _parts(stripped)
        if parts:
            for length in range(1, len(parts) + 1):
                yield (*table, *parts[:length]), number
            yield from (((*table, *parts, key), number) for key in _inline_keys(stripped))
        closing = next((mark for mark in _LONG_TEXTS if line.count(mark) == 1), None)


def _parts(text: str) -> tuple[str, ...]:
    """Return the parts of a dotted key at the beginning of a text; none where a text begins otherwise."""
    parts: list[str] = []
    position = 0
    while (found := _PART.match(text, position)) is not None:
        parts.append(next(group for group in found.groups() if group is not None))
        position = found.end()
        if text[position : position + 1] != ".":
            break
        position += 1
    return tuple(parts) if text[position : position + 1] in ("=", "]") else ()


def _inside(parts: tuple[str, ...], arrays: dict[Path, int], *, begins: bool) -> Path:
    """Return the path of a table's header, in the latest table of each array that it lies in."""
    path: Path = ()
    for part in parts[:-1] if begins else parts:
        path = (*path, part)
        if path in arrays:
            path = (*path, arrays[path])
    if begins:
        path = (*path, *parts[-1:])
        arrays[path] = arrays.get(path, -1) + 1
        path = (*path, arrays[path])
    return path


def _inline_keys(line: str) -> list[str]:
    """Return the keys of an inline table."""
    return re.findall(r"[{,]\s*([A-Za-z0-9_-]+)\s*=", line)
