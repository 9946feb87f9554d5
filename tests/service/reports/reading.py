"""What a report says to whoever opens it."""

import io

import openpyxl
from pypdf import PdfReader

from service.reports.typesetting.sheet import BREAK


def text_of(pdf: bytes) -> str:
    """Return the words of a PDF, without the places where a line may break."""
    words = "\n".join(page.extract_text() for page in PdfReader(io.BytesIO(pdf)).pages)
    return words.replace(BREAK, "").replace("\ufeff", "")


def pages_of(pdf: bytes) -> int:
    """Return how many pages a PDF has."""
    return len(PdfReader(io.BytesIO(pdf)).pages)


def sheets_of(xlsx: bytes) -> dict[str, list[tuple[object, ...]]]:
    """Return the rows of each sheet of a workbook."""
    book = openpyxl.load_workbook(io.BytesIO(xlsx))
    return {sheet.title: [tuple(row) for row in sheet.iter_rows(values_only=True)] for sheet in book}
