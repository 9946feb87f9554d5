"""Recordings as large as an upload may be, and what can be asked of them."""

import json
import time
from collections import Counter
from dataclasses import replace
from functools import cache, partial
from urllib.request import Request, urlopen

import numpy as np

from benchmarks.attacks.attack import Attack, Statuses, Target, at_once
from service.client.credentials import bearer

CHANNELS, SAMPLES = 1600, 20_000
LONGEST_SAMPLES = 800_000
SETTLED_WITHIN_S = 120.0
FORM = "multipart/form-data; boundary=b"
RECORDINGS = "/api/v1/recordings"


def _configuration(data_format: str, channels: int, samples: int, seed: int) -> bytes:
    lines = [f"FACTORY A,{seed},1999", f"{channels},{channels}A,0D"]
    lines += [f"{k},I{k},{'ABC'[k % 3]},,A,0.01,0,0,-32767,32767,1,1,P" for k in range(1, channels + 1)]
    lines += ["50", "1", f"10000,{samples}", "21/11/2026,06:00:00.000000", "21/11/2026,06:00:00.100000"]
    return "\r\n".join([*lines, data_format, "1", ""]).encode("ascii")


@cache
def _wide(seed: int = 0) -> tuple[bytes, bytes]:
    """Configuration and data of 64 MB in binary."""
    row = np.dtype([("number", "<u4"), ("stamp", "<u4"), ("analog", "<i2", (CHANNELS,))])
    data = np.zeros(SAMPLES, dtype=row)
    data["number"] = np.arange(1, SAMPLES + 1)
    data["stamp"] = 100 * np.arange(SAMPLES)
    data["analog"] = np.random.default_rng(seed).integers(-30_000, 30_000, (SAMPLES, CHANNELS))
    return _configuration("BINARY", CHANNELS, SAMPLES, seed), data.tobytes()


def _long(seed: int) -> tuple[bytes, bytes]:
    """Configuration and data of as many values as are diagnosed: six channels for 80 s, 38 MB in ASCII."""
    names, samples = ("IA", "IB", "IC", "VA", "VB", "VC"), LONGEST_SAMPLES
    lines = [f"FACTORY A,{seed},1999", "6,6A,0D"]
    for k, name in enumerate(names, 1):
        unit = "A" if name[0] == "I" else "V"
        lines.append(f"{k},{name},{name[1]},,{unit},0.01,0,0,-32767,32767,1,1,P")
    lines += ["50", "1", f"10000,{samples}", "21/11/2026,06:00:00.000000", "21/11/2026,06:00:00.100000"]
    angle = 2 * np.pi * (50e-4 * np.arange(samples)[:, None] - np.arange(3) / 3)
    values = np.hstack([200 * np.sin(angle - 0.6), 31_000 * np.sin(angle + 0.001 * seed)]).astype(int)
    numbers = np.arange(samples)[:, None]
    table = np.hstack([numbers + 1, 100 * numbers, values])
    data = "\r\n".join(",".join(map(str, row)) for row in table.tolist())
    return "\r\n".join([*lines, "ASCII", "1", ""]).encode("ascii"), data.encode("ascii")


@cache
def _blank() -> tuple[bytes, bytes]:
    """Configuration and data of 64 MB in ASCII, whose values are left out: a byte a value."""
    channels, samples = 6000, 10_500
    lines = [f"{n + 1},{100 * n}{',' * channels}" for n in range(samples)]
    return _configuration("ASCII", channels, samples, 0), "\r\n".join(lines).encode("ascii")


def form_of(configuration: bytes, data: bytes) -> bytes:
    part = b'--b\r\nContent-Disposition: form-data; name="%s"%s\r\n\r\n%s\r\n'
    return b"".join(
        [
            part % (b"motor", b"", b"PUMP-A1"),
            part % (b"files", b'; filename="WIDE.CFG"', configuration),
            part % (b"files", b'; filename="WIDE.DAT"', data),
            b"--b--\r\n",
        ]
    )


def uploaded(target: Target, form: bytes | None = None) -> Target:
    """Upload the record, and wait until its diagnosis has come to an end."""
    status = target.ask("POST", RECORDINGS, form or form_of(*_wide()), FORM)
    assert status == "201", status
    deadline = time.monotonic() + SETTLED_WITHIN_S
    while time.monotonic() < deadline:
        with urlopen(
            Request(f"http://{target.host}:{target.port}{RECORDINGS}", headers=bearer(target.token)),
            timeout=30,
        ) as answer:
            (recording,) = json.load(answer)["items"]
        if recording["state"] not in ("announced", "fetched"):
            break
        time.sleep(0.2)
    return replace(target, recording=recording["id"])


def _waveforms(times: int, points: int, target: Target) -> Statuses:
    path = f"{RECORDINGS}/{target.recording}/waveform?points={points}"
    return at_once(times, lambda: target.ask("GET", path))


def _files(times: int, target: Target) -> Statuses:
    return at_once(times, lambda: target.ask("GET", f"{RECORDINGS}/{target.recording}/file"))


def _upload(times: int, target: Target) -> Statuses:
    forms = [form_of(*_wide(seed)) for seed in range(2)]
    found = at_once(times, lambda: target.ask("POST", RECORDINGS, forms[0], FORM))
    return found + Counter([target.ask("POST", RECORDINGS, forms[1], FORM)])


def _upload_longest(target: Target) -> Statuses:
    """Four of them one after another, so that both workers have one, and waveforms are asked for beside."""
    answers: Statuses = Counter()
    first = uploaded(target, form_of(*_long(0)))
    for seed in range(1, 5):
        form = form_of(*_long(seed))
        answers[target.ask("POST", RECORDINGS, form, FORM)] += 1
        answers += _waveforms(4, 20_000, first)
    return answers


def _upload_blank(target: Target) -> Statuses:
    return Counter([target.ask("POST", RECORDINGS, form_of(*_blank()), FORM)])


ATTACKS = (
    Attack("waveform, 1600 channels x 20,000 points", partial(_waveforms, 1, 20_000), uploaded),
    Attack("60 of these at once", partial(_waveforms, 60, 20_000), uploaded),
    Attack(
        "waveform, 63 million blank values",
        partial(_waveforms, 1, 20_000),
        lambda target: uploaded(target, form_of(*_blank())),
    ),
    Attack("files of 64 MB, 20 at once", partial(_files, 20), uploaded),
    Attack("upload and diagnosis, 64 MB, 8 at once", partial(_upload, 8)),
    Attack("upload and diagnosis, 4 x 8 million values, and waveforms", _upload_longest),
    Attack("upload and diagnosis, 63 million blank values", _upload_blank),
)
