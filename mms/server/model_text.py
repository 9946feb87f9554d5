"""Check of a data model in libiec61850's configuration text before the library reads it.

The library's parser accepts a cut-off file, cuts long lines and strings at a quote, and drops what a data set
or a report control block names but the model lacks. Each of these is an error here, with its line.
"""

import re
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

from mms.errors import ModelError
from mms.references import FunctionalConstraint

_LINE_LIMIT: Final = 1022  # the parser's buffer, less its terminator
_ITEM_LIMIT: Final = 64  # MMS item name, IEC 61850-8-1
_OPENING = re.compile(r"(MODEL|LD|LN|DO|DA|DS|GC|SMVC)(?:\(([^()]*)\))?(=.*)?\{")
_ELEMENT = re.compile(r"\[([0-9]{1,5})\]\{")  # of an array of objects or structs
_CLOSED = re.compile(r"(DA|DE|RC|LC|LOG|SG|PA)\(([^()]*(?:\([^()]*\))?[^()]*)\)(=.*)?;?")
_INITIAL = re.compile(r'="[^"]*"|=[-+]?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?')

_INSIDE: Final[dict[str, frozenset[str]]] = {
    "": frozenset({"MODEL"}),
    "MODEL": frozenset({"LD"}),
    "LD": frozenset({"LN"}),
    "LN": frozenset({"DO", "DS", "RC", "LC", "LOG", "GC", "SG", "SMVC"}),
    "DO": frozenset({"DO", "DA"}),
    "DA": frozenset({"DA"}),
    "DS": frozenset({"DE"}),
    "GC": frozenset({"PA"}),
    "SMVC": frozenset({"PA"}),
}


@dataclass
class _Reading:
    """What the text has named so far."""

    open_blocks: list[tuple[str, str]] = field(default_factory=list)
    items: set[str] = field(default_factory=set)  # "LD/LN$FC$DO$DA", every level
    data_sets: set[str] = field(default_factory=set)  # "LD/LN.name"
    wanted_items: list[tuple[int, str]] = field(default_factory=list)
    wanted_data_sets: list[tuple[int, str]] = field(default_factory=list)
    attributes: list[tuple[str, str]] = field(default_factory=list)  # inst of the LD, and "LN.DO.DA"
    own_names: dict[str, str] = field(default_factory=dict)  # by inst, for LDs with an ldName
    model_name: str = ""

    def path(self) -> list[str]:
        return [name for _, name in self.open_blocks]


def check_model_text(text: str, ied_name: str | None = None) -> tuple[str, ...]:
    """Check a model text and list its data attributes.

    Parameters
    ----------
    text : str
        The library's configuration text.
    ied_name : str, optional
        Name of the IED in place of the text's.

    Returns
    -------
    tuple of str
        References of all data attributes, "LD/LN.DO.DA" with the LD as clients see it.

    Raises
    ------
    ModelError
        The text is wrong; the error names the line of the first fault.
    """
    reading = _read(text)
    name = reading.model_name if ied_name is None else ied_name
    return tuple(
        f"{reading.own_names.get(device, f'{name}{device}')}/{path}" for device, path in reading.attributes
    )


@lru_cache(maxsize=4)
def _read(text: str) -> _Reading:
    """Read the whole text. The result is kept, because many servers may have one text under several names."""
    reading = _Reading()
    for number, line in enumerate(text.splitlines(), 1):
        _read_line(reading, number, line.strip())
    end = f"line {len(text.splitlines())}"
    if reading.open_blocks or not reading.attributes:
        unclosed = (
            f"{len(reading.open_blocks)} blocks still open" if reading.open_blocks else "no data attribute"
        )
        raise ModelError(end, "a complete model, every { closed", unclosed)
    for number, item in reading.wanted_items:
        if item not in reading.items:
            raise ModelError(f"line {number}", "a data set member that the model has", item)
    for number, name in reading.wanted_data_sets:
        if name not in reading.data_sets:
            raise ModelError(f"line {number}", "a data set of the same logical node", name)
    return reading


def _read_line(reading: _Reading, number: int, line: str) -> None:
    where = f"line {number}"
    if not line:
        return
    if len(line.encode("utf-8")) > _LINE_LIMIT:
        raise ModelError(where, f"at most {_LINE_LIMIT} octets", f"{len(line.encode('utf-8'))}")
    if line == "}":
        if not reading.open_blocks:
            raise ModelError(where, "no more }", "a } too many")
        reading.open_blocks.pop()
        return
    element = _ELEMENT.fullmatch(line)
    if element and reading.open_blocks and reading.open_blocks[-1][0] in ("DO", "DA"):
        reading.open_blocks.append((reading.open_blocks[-1][0], f"({element.group(1)})"))
        return
    opening = _OPENING.fullmatch(line)
    entry = opening or _CLOSED.fullmatch(line)
    parent = reading.open_blocks[-1][0] if reading.open_blocks else ""
    if entry is None or entry.group(1) not in _INSIDE[parent]:
        raise ModelError(
            where, f"one of {', '.join(sorted(_INSIDE[parent]))} inside {parent or 'the file'}", line[:60]
        )
    keyword, arguments, initial = entry.groups()
    if initial is not None and not _INITIAL.fullmatch(initial.rstrip(";")):
        raise ModelError(where, 'a number, or a string without " inside', initial[:60])
    words = (arguments or "").split()
    _note(reading, where, number, keyword, words)
    if opening:
        reading.open_blocks.append((keyword, words[0] if words else ""))


def _note(reading: _Reading, where: str, number: int, keyword: str, words: list[str]) -> None:
    path = reading.path()
    if keyword not in ("MODEL", "DE") and not words:
        raise ModelError(where, f"a name for {keyword}", "none")
    match keyword:
        case "MODEL":
            reading.model_name = words[0] if words else ""
        case "LD":
            if len(words) > 1:
                reading.own_names[words[0]] = words[1]
        case "DS":
            reading.data_sets.add(f"{path[1]}/{path[2]}.{words[0]}")
        case "DA":
            _note_attribute(reading, where, [*path[1:], words[0]], words)
        case "DE":
            member = words[0] if words else ""
            reading.wanted_items.append((number, member if "/" in member else f"{path[1]}/{member}"))
        case "RC":
            if len(words) != 9:
                raise ModelError(where, "9 fields of a report control block", str(len(words)))
            if words[3] != "-":
                reading.wanted_data_sets.append((number, f"{path[1]}/{path[2]}.{words[3]}"))


def _note_attribute(reading: _Reading, where: str, path: list[str], words: list[str]) -> None:
    if len(words) < 5 or not all(word.lstrip("-").isdigit() for word in words[1:]):
        raise ModelError(where, "DA(name elements type constraint triggers ...)", " ".join(words))
    try:
        constraint = FunctionalConstraint(int(words[3])).name
    except ValueError as error:
        raise ModelError(where, "a functional constraint from 0 to 18", words[3]) from error
    device, node, *names = path
    # MMS lists an array's name; what its elements hold has no name of its own.
    indices = [depth for depth, name in enumerate(names) if name.startswith("(")]
    listed = names[: indices[0]] if indices else names
    item = "$".join([node, constraint, *listed])
    if len(item) > _ITEM_LIMIT:
        raise ModelError(where, f"an MMS name of at most {_ITEM_LIMIT} characters", item)
    reading.items.update(
        f"{device}/" + "$".join([node, constraint, *listed[:depth]]) for depth in range(len(listed) + 1)
    )
    reading.attributes.append((device, ".".join((node, *names)).replace(".(", "(")))
