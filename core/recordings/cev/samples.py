"""The samples of a Compressed ASCII event report: values, trigger mark and relay word of each line."""

import re
from array import array
from math import isfinite, nan

import numpy as np
from numpy.typing import NDArray

from core.recordings.cev.compressed_ascii import Row
from core.recordings.errors import quoted
from core.recordings.waveform import Digitals

UNUSED = "*"
"""Name of a position of the relay word that carries no bit."""

_LABEL = re.compile(r"(?P<name>[^()]*[^() ]) *\((?P<unit>[^()]*)\)|(?P<volts>V[A-Z0-9]+)kV")
_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,3})?", re.ASCII)
_NO_VALUE = re.compile(r"\$*")
_HEX = re.compile(r"[0-9A-Fa-f]*", re.ASCII)
_BLOCK_ROWS = 1 << 12


class CevSamples:
    """The samples behind the channel labels, collected line by line.

    The last labels are "TRIG" and the names of the relay word.

    Parameters
    ----------
    labels : Row
        The line of labels.
    """

    def __init__(self, labels: Row) -> None:
        self._labels = labels
        self._trig = [label.upper() for label in labels.fields].index("TRIG")
        words = labels.fields[self._trig + 1 :]
        if self._trig == 0 or len(words) > 1:
            raise labels.refuse(
                "channel labels",
                '"TRIG" behind the channels and at most the relay word behind it',
                quoted(",".join(labels.fields)),
            )
        self.channels = tuple(_channel(label) for label in labels.fields[: self._trig])
        self._names = tuple(words[0].split()) if words else ()
        self._digits = -(-len(self._names) // 4)
        self._values = array("d")
        self._words = bytearray()
        self._last_word: bytes | None = None
        self._without_word = 0
        self._marks: dict[str, list[int]] = {">": [], "*": []}
        self.count = 0

    def add(self, row: Row) -> None:
        """Take one line.

        Parameters
        ----------
        row : Row
            The line.

        Raises
        ------
        RecordingError
            If it does not fit the labels, also of a lenient reader.
        """
        if len(row.fields) != len(self._labels.fields):
            raise row.refuse(
                "", f"{len(self._labels.fields)} fields as the channel labels", f"{len(row.fields)} fields"
            )
        values = [
            _value(row, label, text)
            for label, text in zip(self._labels.fields[: self._trig], row.fields, strict=False)
        ]
        mark = row.fields[self._trig]
        if mark.strip(">* "):
            raise row.refuse("TRIG", "> or * or nothing", quoted(mark))
        word = self._word(row) if self._names else b""
        self._values.extend(values)
        self._words += word
        for sign, marked in self._marks.items():
            if sign in mark:
                marked.append(self.count)
        self.count += 1

    def _word(self, row: Row) -> bytes:
        """Return the relay word of a line, that of the line before where it has none."""
        text = row.fields[self._trig + 1]
        if not _HEX.fullmatch(text) or (text and not self._digits <= len(text) <= self._digits + 1):
            raise row.refuse(
                "relay word", f"{self._digits} hexadecimal digits for {len(self._names)} bits", quoted(text)
            )
        if text:
            self._last_word = bytes.fromhex(text[: self._digits].ljust(2 * -(-self._digits // 2), "0"))
            if self._without_word:  # the states of the first lines are known from the first word only
                self._words[:] = self._last_word * self._without_word
                self._without_word = 0
        if self._last_word is None:
            self._without_word += 1
            return bytes(-(-self._digits // 2))
        return self._last_word

    @property
    def trigger_marks(self) -> list[int]:
        """Lines marked as the trigger's: by ">", or by "*" where no line has that."""
        return self._marks[">"] or self._marks["*"]

    def values(self) -> NDArray[np.float64]:
        """Return the analogue values as written, NaN where missing.

        Returns
        -------
        ndarray, shape (channels, samples)
            The values.
        """
        table = np.frombuffer(self._values, dtype=np.float64).reshape(self.count, self._trig)
        return np.array(table.T, order="C")

    def digitals(self) -> Digitals | None:
        """Return the states of the relay word.

        Returns
        -------
        Digitals or None
            The states; None where the report has none.
        """
        used = [k for k, name in enumerate(self._names) if name != UNUSED]
        if not used:
            return None
        words = np.frombuffer(bytes(self._words), dtype=np.uint8).reshape(self.count, -1)
        packed = [
            np.packbits(
                np.unpackbits(words[first : first + _BLOCK_ROWS], axis=1)[:, used], axis=1, bitorder="little"
            )
            for first in range(0, self.count, _BLOCK_ROWS)
        ]
        return Digitals(tuple(self._names[k] for k in used), np.concatenate(packed))


def _channel(label: str) -> tuple[str, str]:
    """Name and unit of an analogue column."""
    if parts := _LABEL.fullmatch(label):
        return (parts["name"], parts["unit"].strip()) if parts["name"] else (parts["volts"], "kV")
    if label.upper() == "FREQ":
        return label, "Hz"
    return label, {"I": "A", "V": "V"}.get(label[:1].upper(), "")


def _value(row: Row, label: str, text: str) -> float:
    if _NO_VALUE.fullmatch(text):
        return nan
    if not _NUMBER.fullmatch(text) or not isfinite(float(text)):
        raise row.refuse(label, "a finite number", quoted(text))
    return float(text)
