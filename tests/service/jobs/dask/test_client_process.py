"""The process that speaks with a scheduler: what it has, and what a pickle can be in it."""

import pickle
import subprocess
import sys
from io import BytesIO
from pathlib import Path

import pytest

from service.jobs.dask_workers import DaskWorkers
from service.jobs.plain_unpickler import ObjectRefusedError, load, loads
from service.recording_store.folder import FolderStore
from testing.service.hostile_scheduler import HONEST
from tests.service.jobs.dask.test_hostile_scheduler import scheduler

SECRETS = {
    "MCC_DATABASE_URL": "postgresql://mcc:RAVEN@localhost/mcc",
    "MCC_RELAY_PASSWORD_A1": "RAVEN",
    "MCC_TOKEN": "RAVEN",
    "AWS_SECRET_ACCESS_KEY": "RAVEN",
    "PGPASSWORD": "RAVEN",
}
PLAIN = [
    None,
    True,
    7,
    0.5,
    1 << 70,
    "text",
    b"octets",
    bytearray(b"o"),
    [1],
    (1, 2),
    {"a": {1, 2}},
    {b"k": [()]},
]


def test_the_client_of_a_scheduler_has_no_secrets_in_its_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in SECRETS.items():
        monkeypatch.setenv(name, value)
    with (
        scheduler(HONEST, tmp_path / "made") as address,
        DaskWorkers.of_scheduler(address, FolderStore(tmp_path), None) as workers,
    ):
        environment = Path(f"/proc/{workers.client_pid}/environ").read_bytes()
        command_line = Path(f"/proc/{workers.client_pid}/cmdline").read_bytes()
        assert workers.problem is None
    assert b"PATH=" in environment
    for text in (environment, command_line):
        assert b"RAVEN" not in text
    assert not any(name.encode() in environment for name in SECRETS)


@pytest.mark.parametrize("value", PLAIN, ids=repr)
def test_plain_data_is_read(value: object) -> None:
    pickled = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    assert loads(pickled) == load(BytesIO(pickled)) == value


def test_octets_outside_a_pickle_are_read() -> None:
    buffers: list[pickle.PickleBuffer] = []
    pickled = pickle.dumps(pickle.PickleBuffer(b"octets"), 5, buffer_callback=buffers.append)
    assert bytes(loads(pickled, buffers=buffers)) == b"octets"
    assert loads(pickle.dumps(bytes)) is bytes


@pytest.mark.parametrize(
    "pickled",
    [
        b"cos\nsystem\n(S'exit'\ntR.",
        b"(S'exit'\nios\nsystem\n.",
        b"\x80\x04\x8c\x05posix\x8c\x06system\x93\x8c\x04exit\x85R.",
        b"\x80\x04\x8c\x08builtins\x8c\x04eval\x93\x8c\x011\x85R.",
        b"\x80\x04\x8c\x08builtins\x8c\x0ebytes.__base__\x93.",
        b"\x80\x02\x82\x01.",
        b"Pmodule\n.",
        b"\x80\x04\x8c\x06module\x51.",
        pickle.dumps(pickle.dumps),
        pickle.dumps(ValueError("an error")),
        pickle.dumps(Path("EVENT.CFF")),
        b"",
        b"nonsense",
        b"\x80\x63N.",
    ],
)
def test_what_names_an_object_or_is_damaged_is_refused(pickled: bytes) -> None:
    with pytest.raises(ObjectRefusedError):
        loads(pickled)


ALL_READERS = """
from service.jobs.plain_unpickler import ObjectRefusedError, refuse_objects
refuse_objects()
import io, pickle, _pickle, cloudpickle
from multiprocessing.reduction import ForkingPickler
import distributed.client, distributed.protocol, distributed.protocol.pickle
hostile = b"cbuiltins\\nexit\\n(I7\\ntR."
loading = [pickle.loads, pickle._loads, _pickle.loads, cloudpickle.loads, ForkingPickler.loads]
loading += [distributed.client.loads, distributed.client.pickle.loads, distributed.protocol.pickle.loads]
reading = [pickle.load, pickle._load, _pickle.load, cloudpickle.load]
classes = [pickle.Unpickler, pickle._Unpickler, _pickle.Unpickler]
reading += [lambda file, of=of: of(file).load() for of in classes]
for read in [*loading, *(lambda octets, of=of: of(io.BytesIO(octets)) for of in reading)]:
    try:
        read(hostile)
    except ObjectRefusedError:
        print("refused")
"""


def test_no_reader_of_the_process_is_left_out() -> None:
    made = subprocess.run(
        [sys.executable, "-c", ALL_READERS], capture_output=True, text=True, timeout=60, check=False
    )
    assert (made.returncode, made.stdout.splitlines()) == (0, ["refused"] * 15), made.stderr
