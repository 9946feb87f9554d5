"""Reading of the library's linked lists."""

import ctypes
from collections.abc import Iterator


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
