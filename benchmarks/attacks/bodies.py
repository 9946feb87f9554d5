"""Request bodies that are large, deep or many, sent where a small JSON document is expected."""

from collections import Counter
from collections.abc import Callable, Iterator

from benchmarks.attacks.attack import Attack, Statuses, Target, at_once

MB = 1_000_000
BASELINE = "/api/v1/motors/PUMP-A1/baseline"
DIAGNOSES = "/api/v1/recordings/00000000-0000-0000-0000-000000000000/diagnoses"
RECORDINGS = "/api/v1/recordings"
JUST_JSON = 8_000
"""So many bytes pass the limit of the JSON routes."""


def _objects(size: int) -> bytes:
    return b'{"recording_ids":[' + b",".join([b"{}"] * (size // 3)) + b"]}"


def _list_of_objects(size: int) -> bytes:
    return b"[" + b",".join([b"{}"] * (size // 3)) + b"]"


def _nested(depth: int) -> bytes:
    return b'{"recording_ids":' + b"[" * depth + b"]" * depth + b"}"


def _integer(digits: int) -> bytes:
    return b'{"recording_ids":[' + b"9" * digits + b"]}"


def _keys(number: int) -> bytes:
    return b"{" + b",".join(b'"k%d":1' % key for key in range(number)) + b"}"


def _text(size: int) -> bytes:
    return b'{"method":"' + b"x" * size + b'"}'


def _endless() -> Iterator[bytes]:
    yield b'{"recording_ids":['
    for _ in range(66):
        yield b"{}," * (MB // 3)
    yield b"{}]}"


def _once(
    method: str, path: str, body: Callable[[], bytes | Iterator[bytes]]
) -> Callable[[Target], Statuses]:
    return lambda target: Counter([target.ask(method, path, body())])


def _many(method: str, path: str, body: bytes, times: int = 60) -> Callable[[Target], Statuses]:
    return lambda target: at_once(times, lambda: target.ask(method, path, body))


def _form(parts: Callable[[], Iterator[bytes]]) -> Callable[[Target], Statuses]:
    return lambda target: Counter(
        [target.ask("POST", RECORDINGS, parts(), "multipart/form-data; boundary=b")]
    )


def _fields() -> Iterator[bytes]:
    for field in range(1000):
        yield b'--b\r\nContent-Disposition: form-data; name="f%d"\r\n\r\n' % field + b"x" * 60_000 + b"\r\n"
    yield b"--b--\r\n"


def _long_header() -> Iterator[bytes]:
    yield b"--b\r\nX-Long: "
    for _ in range(60):
        yield b"x" * MB
    yield b"\r\n\r\n\r\n--b--\r\n"


def _many_headers() -> Iterator[bytes]:
    yield b'--b\r\nContent-Disposition: form-data; name="motor"\r\n'
    for _ in range(600):
        yield b"X-A: b\r\n" * 10_000
    yield b"\r\nPUMP-A1\r\n--b--\r\n"


def _many_files() -> Iterator[bytes]:
    part = b'--b\r\nContent-Disposition: form-data; name="files"; filename="E.CFF"\r\n\r\n%s\r\n'
    for _ in range(999):
        yield part % (b"x" * 60_000)
    yield b"--b--\r\n"


ATTACKS = (
    Attack("baseline, 3 MB of `{}` among the ids", _once("PUT", BASELINE, lambda: _objects(3 * MB))),
    Attack("baseline, 3 MB of `[{},{},...]`", _once("PUT", BASELINE, lambda: _list_of_objects(3 * MB))),
    Attack("baseline, 66 MB of `{}` among the ids", _once("PUT", BASELINE, lambda: _objects(66 * MB))),
    Attack("baseline, 66 MB in chunks", _once("PUT", BASELINE, _endless)),
    Attack("health, 66 MB in chunks", _once("GET", "/healthz", _endless)),
    Attack("baseline, a million lists in one another", _once("PUT", BASELINE, lambda: _nested(MB))),
    Attack("baseline, an integer of 400 digits", _once("PUT", BASELINE, lambda: _integer(400))),
    Attack("baseline, an integer of 3 million digits", _once("PUT", BASELINE, lambda: _integer(3 * MB))),
    Attack("diagnosis, 3 million keys", _once("POST", DIAGNOSES, lambda: _keys(3 * MB))),
    Attack("diagnosis, a text of 60 MB", _once("POST", DIAGNOSES, lambda: _text(60 * MB))),
    Attack("60 at once: 3 MB of `{}`", _many("PUT", BASELINE, _objects(3 * MB))),
    Attack("600 at once: 8 kB of `{}`", _many("PUT", BASELINE, _objects(JUST_JSON), 600)),
    Attack("600 at once: 8 kB of keys", _many("POST", DIAGNOSES, _keys(800), 600)),
    Attack("upload, 1000 fields of 60 kB", _form(_fields)),
    Attack("upload, a part's header of 60 MB", _form(_long_header)),
    Attack("upload, 6 million headers of a part", _form(_many_headers)),
    Attack("upload, 999 files of 60 kB", _form(_many_files)),
)
