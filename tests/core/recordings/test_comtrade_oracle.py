"""The same files read by ours and by the `comtrade` package: where both accept, both must agree."""

from pathlib import Path

import comtrade as oracle
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.recordings import read
from tests.core.recordings.comtrade_files import RECORD_1991, RECORD_1999, RECORD_2013, ComtradeFile

LIMITS = {"ASCII": 99_998, "BINARY": 32_767, "BINARY32": 2**31 - 1, "FLOAT32": 1e6}


@st.composite
def records(draw: st.DrawFn) -> ComtradeFile:
    base = draw(st.sampled_from([RECORD_1991, RECORD_1999, RECORD_2013]))
    formats = ["ASCII", "BINARY"] + (["BINARY32", "FLOAT32"] if base is RECORD_2013 else [])
    data_format = draw(st.sampled_from(formats))
    channels, status = draw(st.integers(1, 6)), draw(st.integers(0, 40))
    samples = draw(st.integers(1, 30))
    rate_hz = draw(st.sampled_from([960, 1000, 4000.5, 10_000]))
    limit = LIMITS[data_format]
    value = (
        st.floats(-limit, limit, width=32)
        if data_format == "FLOAT32"
        else st.integers(-int(limit), int(limit))
    ).filter(lambda count: count != -1)
    factor = st.floats(1e-6, 1e3) | st.floats(-1e3, -1e-6)
    analog = []
    for k in range(1, channels + 1):
        fields = [k, f"CH{k}", "", "", "unit", repr(draw(factor)), repr(draw(st.floats(-1e3, 1e3))), 0, -1, 1]
        analog.append(",".join(map(str, fields + ([] if base is RECORD_1991 else [1, 1, "P"]))))
    short = base is RECORD_1991
    return base.but(
        counts=f"{channels + status},{channels}A,{status}D",
        analog=tuple(analog),
        status=tuple(f"{k},S{k},0" if short else f"{k},S{k},,,0" for k in range(1, status + 1)),
        data_format=data_format,
        rates=("1", f"{rate_hz},{samples}"),
        trigger=base.start,
        rows=[[draw(value) for _ in range(channels)] for _ in range(samples)],
        numbers=range(1, samples + 1),
        stamps=[round(k * 1e6 / rate_hz) for k in range(samples)],
        status_bits=draw(st.integers(0, 0xFFFF)),
    )


@settings(max_examples=60, deadline=None)
@given(record=records())
def test_both_readers_agree(tmp_path_factory: pytest.TempPathFactory, record: ComtradeFile) -> None:
    if record.data_format == "ASCII":  # its 40 status bits are drawn from 16
        record = record.but(status_bits=record.status_bits * 0x10001)
    path = record.write(tmp_path_factory.mktemp("r"))
    ours = read(path)
    theirs = oracle.load(str(path), use_numpy_arrays=True, use_double_precision=True, ignore_warnings=True)
    tolerance = 1e-6 if record.data_format == "FLOAT32" else 1e-12
    np.testing.assert_allclose(ours.samples, np.array(theirs.analog), rtol=tolerance, atol=1e-9)
    assert ours.sample_rate_hz == theirs.cfg.sample_rates[0][0]
    assert ours.samples.shape[1] == theirs.total_samples
    assert [c.name for c in ours.channels] == theirs.analog_channel_ids
    assert ours.station == theirs.station_name
    if record.identification != RECORD_1991.identification:  # it takes 1991's two digits for the year 24
        stamp = theirs.start_timestamp.isoformat(timespec="microseconds")
        assert np.datetime64(ours.start_time_ns, "ns") == np.datetime64(stamp)


def test_where_it_fills_in_we_refuse(tmp_path: Path) -> None:
    """The package reads a truncated file as zeros; that is why the strict reader exists."""
    path = RECORD_1999.write(tmp_path)
    data = path.with_suffix(".dat")
    data.write_bytes(data.read_bytes()[:40])
    theirs = oracle.load(str(path))
    assert list(theirs.analog[1])[2:] == [0, 0, 0]
    with pytest.raises(ValueError, match="size"):
        read(path)
