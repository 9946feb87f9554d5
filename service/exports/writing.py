"""Writes a table in any format, piece by piece."""

from collections.abc import Iterable, Iterator, Sequence

from service.exports.csv_file import csv_pieces
from service.exports.formats import Format
from service.exports.tables import Record, Table


def pieces(wanted: Format, table: Table[Record], batches: Iterable[Sequence[Record]]) -> Iterator[bytes]:
    """Return a file of this format in pieces; memory holds one batch, or one row group, at a time."""
    if wanted is Format.CSV:
        return csv_pieces(table, batches)
    if wanted is Format.XLSX:
        from service.exports.excel_file import excel_pieces

        return excel_pieces(table, batches)
    from service.exports.parquet_file import parquet_pieces

    return parquet_pieces(table, batches)
