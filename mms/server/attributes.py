"""Data attributes of one server: read, updated, and updates of other threads that wait to be applied."""

import ctypes
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Final

from mms.binding.callbacks import log
from mms.binding.value_conversion import decode
from mms.errors import ModelError
from mms.server.model import Model, Node
from mms.values import Quality, Value

_Update = tuple[str, int, int]
"""An attribute's reference, its node, and the value that it is to have."""


def _data_object(reference: str) -> str:
    """Return the reference of the data object, "LD/LN.DO"."""
    return ".".join(reference.split(".")[:2])


class Attributes:
    """Data attributes of one server. All but `post` is called with the server locked.

    `has_clients` tells whether there may be any: before, values are the first ones, and no report tells them.
    The library would look through all reports of the server at each.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    model : Model
        The server's data model.
    server : int
        Pointer to the IedServer.
    """

    def __init__(self, lib: ctypes.CDLL, model: Model, server: int) -> None:
        self._lib: Final = lib
        self._model: Final = model
        self._server: Final = server
        self._posted: Final[deque[Mapping[str, Value | Quality]]] = deque()
        self._library_holds_model = False
        self.has_clients = False

    def read(self, reference: str) -> Value:
        """Read an attribute.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO.DA".

        Returns
        -------
        Value
            The present value.

        Raises
        ------
        ModelError
            There is no such attribute.
        """
        node = self._model.node(reference, Node.DATA_ATTRIBUTE)
        return decode(self._lib, self._value(reference, node))

    def update(self, values: Mapping[str, Value | Quality], *, whole_objects: bool = False) -> None:
        """Set attributes as one change. Times are set first, so that an event carries its own.

        Parameters
        ----------
        values : mapping of str to Value or Quality
            New values by reference.
        whole_objects : bool
            Whether data sets have whole objects alone: one event tells all changes of an object's values.

        Raises
        ------
        ModelError
            There is no such attribute, or a value does not fit its type. Nothing is changed then.
        """
        lib = self._lib
        prepared: list[_Update] = []
        try:
            for reference in sorted(values, key=lambda name: not name.endswith(".t")):
                node = self._model.node(reference, Node.DATA_ATTRIBUTE)
                new = lib.MmsValue_clone(self._value(reference, node))
                prepared.append((reference, node, new))
                self._model.assign(reference, node, new, values[reference])
            self._apply(prepared, whole_objects=whole_objects)
        finally:
            for _, _, new in prepared:
                lib.MmsValue_delete(new)

    def _value(self, reference: str, node: int) -> int:
        """Return the library's value. It keeps none of what is only operated (functional constraint CO)."""
        value = self._lib.IedServer_getAttributeValue(self._server, node)
        if not value:
            raise ModelError(reference, "an attribute with a value", "one without (constraint CO, say)")
        return int(value)

    def _apply(self, prepared: Sequence[_Update], *, whole_objects: bool) -> None:
        lib = self._lib
        if not self.has_clients:
            for reference, node, new in prepared:
                lib.MmsValue_update(self._value(reference, node), new)
            return
        lock_model = not self._library_holds_model
        if lock_model:
            lib.IedServer_lockDataModel(self._server)
        for _, node, new in self._untold(prepared) if whole_objects else prepared:
            lib.IedServer_updateAttributeValue(self._server, node, new)
        if lock_model:
            lib.IedServer_unlockDataModel(self._server)

    def _untold(self, prepared: Sequence[_Update]) -> Sequence[_Update]:
        """Set all but the last value and the quality that change in each object; return those.

        The library would close a report at the second event of a member for the same reason.
        """
        lib = self._lib
        last: dict[tuple[str, bool], int] = {}
        for place, (reference, node, new) in enumerate(prepared):
            if not lib.MmsValue_equals(self._value(reference, node), new):
                last[_data_object(reference), reference.endswith(".q")] = place
        telling = sorted(last.values())
        for place in set(range(len(prepared))).difference(telling):
            reference, node, new = prepared[place]
            lib.MmsValue_update(self._value(reference, node), new)
        return [prepared[place] for place in telling]

    def post(self, values: Mapping[str, Value | Quality]) -> None:
        """Queue one change. Any thread may call this, and none waits.

        Parameters
        ----------
        values : mapping of str to Value or Quality
            New values by reference.
        """
        self._posted.append(values)

    def apply_posted(self) -> None:
        """Apply the queued changes in their order.

        Raises
        ------
        ModelError
            A change does not fit the model. Those after it stay queued.
        """
        while self._posted:
            self.update(self._posted.popleft())

    def apply_posted_or_log(self) -> None:
        """Apply the queued changes in their order; log those that do not fit the model."""
        while self._posted:
            try:
                self.apply_posted()
            except ModelError:
                log.exception("a posted change does not fit the model")

    @contextmanager
    def held_by_library(self) -> Iterator[None]:
        """Mark that the library has locked its model. What is posted meanwhile is applied at the end.

        Yields
        ------
        None
            Nothing.
        """
        self._library_holds_model = True
        try:
            yield
            self.apply_posted_or_log()
        finally:
            self._library_holds_model = False
