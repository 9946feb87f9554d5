"""The library's linked lists, read and made."""

import ctypes
from collections.abc import Iterator, Sequence
from contextlib import contextmanager


@contextmanager
def list_of_names(lib: ctypes.CDLL, names: Sequence[bytes]) -> Iterator[int]:
    """Make a list of names, which lasts as long as the block.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    names : sequence of bytes
        The names, without NUL.

    Yields
    ------
    int
        Pointer to a LinkedList of C strings.
    """
    kept = [ctypes.create_string_buffer(name) for name in names]
    linked_list = lib.LinkedList_create()
    try:
        for name in kept:
            lib.LinkedList_add(linked_list, ctypes.addressof(name))
        yield linked_list
    finally:
        lib.LinkedList_destroyStatic(linked_list)  # the names are Python's


def take_names(lib: ctypes.CDLL, linked_list: int | None) -> list[str]:
    """Read a list of names and free it.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    linked_list : int or None
        Pointer to a LinkedList of C strings.

    Returns
    -------
    list of str
        The names, their octets read as Latin-1; empty for None.
    """
    if linked_list is None:
        return []
    names = [ctypes.string_at(data).decode("latin-1") for data in elements(lib, linked_list)]
    lib.LinkedList_destroy(linked_list)
    return names


def elements(lib: ctypes.CDLL, linked_list: int) -> Iterator[int]:
    """Iterate over a list of the library.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    linked_list : int
        Pointer to a LinkedList.

    Yields
    ------
    int
        Pointer to the data of each element.
    """
    element = lib.LinkedList_getNext(linked_list)
    while element:
        yield lib.LinkedList_getData(element)
        element = lib.LinkedList_getNext(element)
