"""Text of record files: UTF-8, or the code page its letters speak for.

COMTRADE before 2013 and Compressed ASCII know no code page; relays write that of the engineer's computer.
A wrong guess misspells a name; it never changes a number, a comma or a line: all pages share them with ASCII.
"""

import codecs
import re

_MARKS = (
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""Byte order marks; that of UTF-32 begins with that of UTF-16."""
_NULLS_TOLD_BY = 64
"""Bytes of a text without a mark by which its encoding is told."""
_RUN = re.compile(rb"([A-Za-z]?)([\x80-\xff]+)(?=([A-Za-z]?))")
_HIGH = re.compile(rb"[\x80-\xff]")
_SAMPLE_BYTES = 1 << 16
"""From the first letter above ASCII on: enough to tell a page by."""
_CYRILLIC = re.compile("[А-ЯЁ]*[а-яё]*")
_CHINESE = re.compile("[\u3000-\u303f\u4e00-\u9fff\uff00-\uffef]+")
_SURE = 0.7
"""Share of the letters that must look Cyrillic: abbreviations such as "ТНкВ" have capitals inside."""


def decode_text(content: bytes) -> str:
    """Decode a text whose code page is not known; a byte order mark is taken off.

    Every content has a text: the last resort is Latin-1. UTF-16 and UTF-32 are told by `wide_encoding`. UTF-8
    is taken where it fits. Else Latin-1 is taken where most letters above ASCII stand singly among ASCII
    letters, or in twos between them ("Estação"). Else CP1251 or CP866 is taken where runs of such letters are
    Cyrillic with capitals first; else GBK where all are Chinese characters; else Latin-1.

    Parameters
    ----------
    content : bytes
        The bytes.

    Returns
    -------
    str
        The text.
    """
    if wide := wide_encoding(content):
        return content.decode(wide, errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        pass
    high = _HIGH.search(content)
    begin = max(high.start() - 1, 0) if high else 0
    latin, foreign = 0, []
    for before, run, after in _RUN.findall(content[begin : begin + _SAMPLE_BYTES]):
        if (len(run) == 1 and (before or after)) or (len(run) == 2 and before and after):
            latin += len(run)
        elif len(run) > 1:
            foreign.append(run)
    if sum(map(len, foreign)) <= latin:
        return content.decode("latin-1")
    for page in ("cp1251", "cp866"):
        if _cyrillic_share(foreign, page) >= _SURE:
            return content.decode(page, errors="replace")
    if all(_CHINESE.fullmatch(run.decode("gbk", errors="replace")) for run in foreign):
        return content.decode("gb18030", errors="replace")
    return content.decode("latin-1")


def wide_encoding(content: bytes) -> str | None:
    """Tell whether a text has two or four bytes a letter, as programs of Windows save it.

    A byte order mark tells it, or zeros in every other byte and in no byte between; names in letters of their
    own may have others in up to half of those places.

    Parameters
    ----------
    content : bytes
        The text, or its first bytes.

    Returns
    -------
    str or None
        UTF-16 or UTF-32 as Python names it; None for a text of single bytes.
    """
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    even, odd = content[:_NULLS_TOLD_BY:2], content[1:_NULLS_TOLD_BY:2]
    for zeros, letters, encoding in ((odd, even, "utf-16-le"), (even, odd, "utf-16-be")):
        if odd and 2 * zeros.count(0) >= len(zeros) and all(letters):
            return encoding
    return None


def _cyrillic_share(runs: list[bytes], page: str) -> float:
    """Bytes in runs that are Cyrillic and capitalised as people do, over all."""
    fitting = sum(len(run) for run in runs if _CYRILLIC.fullmatch(run.decode(page, errors="replace")))
    return fitting / sum(map(len, runs))
