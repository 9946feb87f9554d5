"""Tables as Parquet, one row group after another. pyarrow is an extra, and imported when it is needed."""

import io
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from service.exports.tables import Cell, ColumnType, Record, Table

ROW_GROUP = 20_000
"""Rows of a row group, about: readers like few large ones, and one is held in memory."""


def parquet_pieces(table: Table[Record], batches: Iterable[Sequence[Record]]) -> Iterator[bytes]:
    """Return the file in pieces of one row group each.

    Times are time stamps in UTC, in nanoseconds. The metadata of each field has its unit and its meaning.
    """
    import pyarrow as pa
    from pyarrow import parquet

    types = {
        ColumnType.TEXT: pa.string(),
        ColumnType.NUMBER: pa.float64(),
        ColumnType.WHOLE: pa.int64(),
        ColumnType.TIME: pa.timestamp("ns", tz="UTC"),
    }
    schema = pa.schema(
        pa.field(column.name, types[column.type], metadata={"unit": column.unit, "meaning": column.meaning})
        for column in table.columns
    )

    def group(rows: Sequence[Sequence[Cell]]) -> Any:
        cells = zip(*rows, strict=True) if rows else ((),) * len(schema)
        arrays = [pa.array(column, field.type) for column, field in zip(cells, schema, strict=True)]
        return pa.record_batch(arrays, schema=schema)

    sink = _Sink()
    with parquet.ParquetWriter(sink, schema, compression="snappy") as writer:
        waiting: list[list[Cell]] = []
        for batch in batches:
            waiting += table.rows(batch)
            if len(waiting) >= ROW_GROUP:
                writer.write_batch(group(waiting))
                waiting = []
                yield sink.taken()
        if waiting:
            writer.write_batch(group(waiting))
    yield sink.taken()


class _Sink(io.RawIOBase):
    """A file that cannot be wound back; what is written waits until it is taken."""

    def __init__(self) -> None:
        super().__init__()
        self._waiting = bytearray()
        self._taken_bytes = 0

    def writable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._taken_bytes + len(self._waiting)

    def write(self, content: Any, /) -> int:
        self._waiting += content
        return len(content)

    def taken(self) -> bytes:
        """Return what was written since the last time."""
        content = bytes(self._waiting)
        self._taken_bytes += len(content)
        self._waiting.clear()
        return content
