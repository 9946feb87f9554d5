"""Safe parsing of an XML file.

The file may be hostile, so the parser allows no document type, no entities and no network, and bounds size
and depth.
"""

import codecs
import re
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from scl.errors import SclError

LARGEST_FILE_BYTES = 256 * 1024 * 1024
MOST_ATTRIBUTES = 200
"""Of one element. The schema has at most a dozen; some tools add their own in other namespaces."""
_ELEMENT_WITH_MORE = etree.XPath(f"(//*[@*[{MOST_ATTRIBUTES + 1}]])[1]")
UNDECLARED_PREFIX = etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE
"""Tools write xsi:type and forget to declare xsi. The XML itself is well-formed."""
EXCERPT = 60
"""Characters of what a message quotes."""
_WIDE = {
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
    b"<\0": "utf-16-le",
    b"\0<": "utf-16-be",
}
"""Encodings of two bytes a letter, by how a file begins."""
_ENCODING = re.compile(r"^(\s*<\?xml[^>]*?)\s+encoding\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_LATE_DECLARATION = re.compile(rb"(?:\xef\xbb\xbf)?(\s+)(<\?xml\s[^>]*\?>)")

IDENTITY = ("name", "id", "inst", "iedName", "apName", "prefix", "lnClass", "lnType", "type", "doName")


@dataclass(frozen=True, slots=True)
class ParsedFile:
    """An XML file as parsed.

    Parameters
    ----------
    tree : lxml.etree._ElementTree
        The XML tree, without comments.
    first_undeclared_prefix : str or None
        What the parser says of the first name whose namespace prefix the file does not declare; None if
        it declares all. Such names keep their prefix: they are no names of SCL.
    remarks : tuple of str, optional
        What had to be put right before the file was XML.
    """

    tree: etree._ElementTree
    first_undeclared_prefix: str | None
    remarks: tuple[str, ...] = ()


def parse(path: Path, *, largest_bytes: int = LARGEST_FILE_BYTES) -> ParsedFile:
    """Parse an XML file without its comments.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    largest_bytes : int
        Size above which the file is refused [byte].

    Returns
    -------
    ParsedFile
        The XML tree, and what is odd in its namespaces.

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
    data, remarks = _put_right(path, data)
    parser = _parser()
    undeclared = None
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        fault = next((entry for entry in parser.error_log if entry.type != UNDECLARED_PREFIX), None)
        if fault is not None:
            raise SclError(path, line=fault.line, expected="well-formed XML", found=fault.message) from error
        undeclared = str(error.msg)
        root = etree.fromstring(data, _parser(recover=True))
    tree = root.getroottree()
    if tree.docinfo.doctype:
        raise SclError(
            path, expected="no document type declaration (it can define entities)", found=tree.docinfo.doctype
        )
    _require_few_attributes(path, root)
    return ParsedFile(tree, undeclared, remarks)


def _put_right(path: Path, data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """Return the text in UTF-8 where it was in UTF-16, and its declaration at its beginning, with remarks."""
    remarks = []
    encoding = next((one for begin, one in _WIDE.items() if data.startswith(begin)), None)
    if encoding is not None:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError as error:
            raise SclError(path, expected="a text in UTF-16", found=str(error)) from error
        data = _ENCODING.sub(r"\1", text.removeprefix("\ufeff"), count=1).encode("utf-8")
        remarks.append("the text is UTF-16: read as such")
    if late := _LATE_DECLARATION.match(data):
        data = late[2] + late[1] + data[late.end() :]  # lines keep their numbers
        remarks.append("blanks before the XML declaration are passed over")
    return data, tuple(remarks)


def _require_few_attributes(path: Path, root: etree._Element) -> None:
    """Raise SclError where an element has more than it may: each look at one goes through all of them."""
    found = _ELEMENT_WITH_MORE(root)
    if isinstance(found, list) and found:
        element = found[0]
        raise SclError(
            path,
            line=element.sourceline,
            element=f"<{etree.QName(element).localname}>",
            expected=f"at most {MOST_ATTRIBUTES} attributes of an element",
            found=f"{len(element.attrib)}",
        )


def _parser(*, recover: bool = False) -> etree.XMLParser:
    return etree.XMLParser(
        resolve_entities=False,
        load_dtd=False,
        no_network=True,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
        recover=recover,
    )


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


def excerpt(element: etree._Element) -> str:
    """Shorten a start tag for a message: its name and the attributes that identify it.

    Parameters
    ----------
    element : lxml.etree._Element
        The element.

    Returns
    -------
    str
        The text.
    """
    name = etree.QName(element).localname
    identity = [f'{key}="{element.get(key)}"' for key in IDENTITY if element.get(key) is not None]
    text = " ".join([name, *identity])
    return f"<{text if len(text) <= EXCERPT else text[:EXCERPT] + '...'}>"
