"""How large data types become when they are written out, and how large they may become.

Types that multiply (a type of ten members of a type of ten members ...) would fill any memory.
"""

from dataclasses import dataclass
from typing import Self

from lxml import etree

from scl.document import Document
from scl.errors import SclError

DEEPEST_NESTING = 16
MOST_ATTRIBUTES = 100_000
"""Of a data object with the elements of its arrays; harmonics of real relays have several thousands."""
LONGEST_PATH = 128


class UnboundedTypeError(SclError):
    """A type contains itself, or is too large, too deep or too long in its names."""


@dataclass(frozen=True, slots=True)
class Extent:
    """Size of a type when it is written out.

    Parameters
    ----------
    attributes : int
        Number of its attributes, every element of an array counted.
    written : int
        The same with arrays counted once.
    depth : int
        Its levels.
    characters : int
        Length of its longest path, also to what elements of an array hold: "har(12).cVal".
    listed : int
        Length of its longest MMS name, which ends at an array.
    """

    attributes: int = 0
    written: int = 0
    depth: int = 1
    characters: int = 0
    listed: int = 0

    def plus(self, name: str, count: int, part: Self | None) -> "Extent":
        """Add a member.

        Parameters
        ----------
        name : str
            Name of the member.
        count : int
            Number of its array elements, 0 for no array.
        part : Extent or None
            Extent of its type; None for a basic type.

        Returns
        -------
        Extent
            The extent with the member.
        """
        elements, index = max(count, 1), f"({count - 1})" if count else ""
        if part is None:
            attributes, written, depth, characters, listed = 0, 0, 0, len(name + index), len(name)
        else:
            attributes, written, depth = part.attributes, part.written, part.depth
            characters = len(f"{name}{index}.") + part.characters
            listed = len(name) if count else len(f"{name}$") + part.listed
        return Extent(
            attributes=self.attributes + elements * (1 + attributes),
            written=self.written + 1 + written,
            depth=max(self.depth, 1 + depth),
            characters=max(self.characters, characters),
            listed=max(self.listed, listed),
        )


def check_extent(document: Document, element: etree._Element, extent: Extent) -> None:
    """Check the extent of a type or of a data object.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element
        The element of the type or data object.
    extent : Extent
        Its extent.

    Raises
    ------
    UnboundedTypeError
        It is too large, too deep or too long.
    """
    if (
        extent.attributes > MOST_ATTRIBUTES
        or extent.depth > DEEPEST_NESTING
        or extent.characters > LONGEST_PATH
    ):
        raise document.error(
            element,
            f"at most {MOST_ATTRIBUTES} attributes, {DEEPEST_NESTING} levels, {LONGEST_PATH} characters",
            f"{extent.attributes} attributes, {extent.depth} levels, {extent.characters} characters",
            UnboundedTypeError,
        )
