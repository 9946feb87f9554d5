"""Safe parsing of an XML file.

The file may be hostile, so the parser allows no document type, no entities and no network, and bounds size
and depth.
"""

from pathlib import Path

from lxml import etree

from scl.errors import SclError

LARGEST_FILE_BYTES = 256 * 1024 * 1024


def parse(path: Path, *, largest_bytes: int = LARGEST_FILE_BYTES) -> etree._ElementTree:
    """Parse an XML file without its comments.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    largest_bytes : int
        Size above which the file is refused [byte].

    Returns
    -------
    lxml.etree._ElementTree
        The XML tree.

    Raises
    ------
    SclError
        The file cannot be read, is too large, or is no well-formed and safe XML.
    """
    try:
        with path.open("rb") as file:
            data = file.read(largest_bytes + 1)
    except OSError as error:
        raise SclError(path, expected="a readable file", found=error.strerror or str(error)) from error
    except ValueError as error:  # a NUL in the path
        raise SclError(path, expected="a file name", found=str(error)) from error
    if len(data) > largest_bytes:
        raise SclError(path, expected=f"at most {largest_bytes} bytes", found="a larger file")
    parser = etree.XMLParser(
        resolve_entities=False,
        load_dtd=False,
        no_network=True,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise SclError(path, line=error.lineno, expected="well-formed XML", found=str(error.msg)) from error
    tree = root.getroottree()
    if tree.docinfo.doctype:
        raise SclError(
            path, expected="no document type declaration (it can define entities)", found=tree.docinfo.doctype
        )
    return tree


def content(element: etree._Element) -> str:
    """Read the text of an element, without surrounding blanks.

    Parameters
    ----------
    element : lxml.etree._Element
        The element.

    Returns
    -------
    str
        The text.
    """
    return (element.text or "").strip()
