import io
from math import nan

import pyarrow as pa
import pytest
from pyarrow import parquet

from core.error_words import one_line
from service.exports import parquet_file
from service.exports.parquet_file import parquet_pieces
from tests.service.exports.rows import EMPTY, HOSTILE, TABLE, Row


def written(*rows: Row) -> pa.Table:
    return parquet.read_table(io.BytesIO(b"".join(parquet_pieces(TABLE, [rows]))))


def test_types_units_and_what_is_not_known() -> None:
    table = written(Row(), EMPTY, Row(level=nan))
    assert table.schema.types == [pa.timestamp("ns", tz="UTC"), pa.string(), pa.float64(), pa.int64()]
    assert table.schema.field("size_bytes").metadata == {b"unit": b"byte", b"meaning": b"how long it is"}
    assert table["time"].cast(pa.int64()).to_pylist() == [
        1_760_000_000_123_456_789,
        None,
        1_760_000_000_123_456_789,
    ]
    assert table["level"].to_pylist() == [0.0121, None, None]
    assert table["words"].to_pylist() == ["PUMP-A1", None, "PUMP-A1"]


def test_a_table_without_rows_has_its_columns() -> None:
    assert written().column_names == ["time", "words", "level", "size_bytes"]


def test_hostile_texts_are_kept_in_one_line() -> None:
    found = written(*(Row(words=text) for text in HOSTILE))["words"].to_pylist()
    assert found == [one_line(text) for text in HOSTILE]


def test_row_groups_come_one_after_another(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parquet_file, "ROW_GROUP", 20)
    batches = [[Row(size=at * 10 + one) for one in range(10)] for at in range(5)]
    pieces = list(parquet_pieces(TABLE, batches))
    assert len(pieces) == 3
    file = parquet.ParquetFile(io.BytesIO(b"".join(pieces)))
    assert file.num_row_groups == 3
    assert file.read()["size_bytes"].to_pylist() == list(range(50))
