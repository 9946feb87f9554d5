"""SEL Compressed ASCII event reports. No other reader of them is at hand."""

from benchmarks.corpus.comtrade_files import read_record
from benchmarks.corpus.outcomes import Kind

EVENT_REPORT = Kind(name="CEV", suffixes=(".cev",), read=read_record)
