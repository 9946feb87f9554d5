"""Data model of a server in the library: built from text, asked for nodes, freed after its server."""

import ctypes
import tempfile
import threading
from enum import IntEnum
from typing import Final

from mms.binding.value_conversion import TypeMismatchError, assign
from mms.errors import ModelError
from mms.server.model_text import check_model_text
from mms.values import Quality, Value

_REFERENCE_LIMIT: Final = 128
_parser_lock: Final = threading.Lock()
"""Lets one thread parse at a time: the library's parser keeps its line in a static buffer."""


class Node(IntEnum):
    """Kinds of node, with the numbers of the library's ModelNodeType."""

    DATA_OBJECT = 2
    DATA_ATTRIBUTE = 3

    @property
    def words(self) -> str:
        """The kind in words."""
        return f"a {self.name.lower().replace('_', ' ')}"


# By the library's DataAttributeType.
_INTEGER_RANGES: Final = {
    1: (-(1 << 7), (1 << 7) - 1),  # INT8
    2: (-(1 << 15), (1 << 15) - 1),  # INT16
    3: (-(1 << 31), (1 << 31) - 1),  # INT32
    4: (-(1 << 63), (1 << 63) - 1),  # INT64
    6: (0, (1 << 8) - 1),  # INT8U
    7: (0, (1 << 16) - 1),  # INT16U
    8: (0, (1 << 24) - 1),  # INT24U
    9: (0, (1 << 32) - 1),  # INT32U
    12: (-(1 << 7), (1 << 7) - 1),  # ENUMERATED, an INT8 in IEC 61850-8-1
}
_LONGEST_STRINGS: Final = {16: 32, 17: 64, 18: 65, 19: 129, 20: 255, 21: 255, 30: 3}  # octets
_LONGEST_STRING: Final = 255


class Model:
    """Data model in the library. Every reference is "LD/LN.DO.DA" with the LD as clients see it.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    text : str
        The library's configuration text.
    ied_name : str or None
        Name of the IED in place of the text's.

    Raises
    ------
    ModelError
        The text is wrong, or the library makes less of it than it says.
    """

    def __init__(self, lib: ctypes.CDLL, text: str, ied_name: str | None) -> None:
        attributes = check_model_text(text, ied_name)
        self._lib = lib
        self._nodes: dict[str, int] = {}
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", suffix=".cfg") as file:
            file.write(text)
            file.flush()
            with _parser_lock:
                self.pointer = int(lib.ConfigFileParser_createModelFromConfigFileEx(file.name.encode()) or 0)
        if not self.pointer:
            raise ModelError("the model text", "a text the MMS library can read", "it refuses the text")
        name = ied_name if ied_name is not None else _ied_name(text)
        lib.IedModel_setIedNameForDynamicModel(self.pointer, name.encode("ascii"))
        try:
            for attribute in attributes:
                self.node(attribute, Node.DATA_ATTRIBUTE)
        except ModelError:
            self.destroy()
            raise
        self._nodes.clear()

    def node(self, reference: str, kind: Node) -> int:
        """Find the library's node of a reference.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO" or "LD/LN.DO.DA".
        kind : Node
            Expected kind of node.

        Returns
        -------
        int
            Pointer to the node.

        Raises
        ------
        ModelError
            There is no such node, or it is of another kind.
        """
        node = self._nodes.get(reference)
        if node is None:
            if not reference.isascii() or len(reference) > _REFERENCE_LIMIT:
                raise ModelError(reference, "an object reference", "too long or not ASCII")
            found = self._lib.IedModel_getModelNodeByObjectReference(self.pointer, reference.encode("ascii"))
            if not found:
                raise ModelError(reference, "an object of this model", "none of that name")
            node = self._nodes[reference] = int(found)
        if int(self._lib.ModelNode_getType(node)) != kind:
            raise ModelError(reference, kind.words, "another kind of node")
        return node

    def assign(self, reference: str, node: int, target: int, value: Value | Quality) -> None:
        """Put a value for an attribute into the library's value.

        Parameters
        ----------
        reference : str
            Reference of the attribute, for messages.
        node : int
            Pointer to the attribute's node.
        target : int
            Pointer to the MmsValue.
        value : Value or Quality
            The value.

        Raises
        ------
        ModelError
            The value does not fit the attribute.
        """
        kind = int(self._lib.DataAttribute_getType(node))
        try:
            _check_range(kind, value)
            assign(self._lib, target, value, longest_string=_LONGEST_STRINGS.get(kind, _LONGEST_STRING))
        except TypeMismatchError as error:
            raise ModelError(reference, error.expected, error.found) from error

    def destroy(self) -> None:
        """Free the model. Its server must have been destroyed before."""
        pointer, self.pointer = self.pointer, 0
        if pointer:
            self._lib.IedModel_destroy(pointer)
        self._nodes.clear()


def _check_range(kind: int, value: Value | Quality) -> None:
    """Check an integer against its type, because the library lets 128 into an INT8."""
    if kind in _INTEGER_RANGES and isinstance(value, int):
        lowest, highest = _INTEGER_RANGES[kind]
        if not lowest <= value <= highest:
            raise TypeMismatchError(f"an int from {lowest} to {highest}", value)


def _ied_name(text: str) -> str:
    first = next(line.strip() for line in text.splitlines() if line.strip())
    return first.removeprefix("MODEL").strip("({)")
