"""The formats of an export, and the media type of each."""

from enum import StrEnum
from importlib.util import find_spec


class Format(StrEnum):
    """A format; its value is also the suffix of a file's name."""

    CSV = "csv"
    XLSX = "xlsx"
    PARQUET = "parquet"

    @property
    def media_type(self) -> str:
        """Return its media type, as IANA has it."""
        return _MEDIA_TYPES[self]

    @property
    def missing(self) -> str | None:
        """Return what has to be installed to write it; None where nothing is missing."""
        if self is Format.PARQUET and find_spec("pyarrow") is None:
            return "Parquet needs pyarrow, which is not installed here: pip install 'statorwatch[parquet]'"
        return None


_MEDIA_TYPES = {
    Format.CSV: "text/csv",
    Format.XLSX: "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    Format.PARQUET: "application/vnd.apache.parquet",
}
