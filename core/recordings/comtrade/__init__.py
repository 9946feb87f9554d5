"""COMTRADE recordings (IEEE C37.111, IEC 60255-24): read, checked and written."""

from core.recordings.comtrade.reader import read_combined_comtrade, read_comtrade
from core.recordings.comtrade.writer import configuration_text, data_bytes, write

__all__ = ["configuration_text", "data_bytes", "read_combined_comtrade", "read_comtrade", "write"]
