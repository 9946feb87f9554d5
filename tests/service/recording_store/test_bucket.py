"""A bucket of a real server: its keys, damage, hostile names, and every way in which a server fails."""

import threading
import time
import traceback
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from service.configuration.recordings_url import BucketPlace
from service.configuration.settings import Settings, SettingsError
from service.recording_store import bucket, bucket_client
from service.recording_store.bucket import BucketStore
from service.recording_store.bucket_client import CHUNK_BYTES, Bucket, forget_clients
from service.recording_store.contents import StoredFile, manifest_digest
from service.recording_store.endpoint import goes_in_clear, require_sound
from service.recording_store.errors import RecordingStoreError, StoreError, StoreUnreachableError
from testing.service.s3_server import BUCKET, NONSENSE, SECRET, Fault, S3Server, serving_s3
from testing.waiting import wait_until

FILES: dict[str, Path | bytes] = {"C_0001.CFG": b"config", "C_0001.DAT": b"samples"}
MB = 1_000_000


def own_keys(s3: S3Server, place: BucketPlace) -> list[str]:
    return [key.removeprefix(place.prefix) for key in s3.keys_of() if key.startswith(place.prefix)]


def test_the_keys_are_those_of_the_folder(s3: S3Server, in_bucket: BucketStore, place: BucketPlace) -> None:
    digest = in_bucket.store(FILES).digest
    folder = f"{digest[:2]}/{digest}"
    assert own_keys(s3, place) == [f"{folder}/C_0001.CFG", f"{folder}/C_0001.DAT"]


def test_a_record_is_there_when_all_of_its_files_are(
    s3: S3Server, in_bucket: BucketStore, place: BucketPlace
) -> None:
    stored = in_bucket.store(FILES)
    key = f"{place.prefix}{stored.digest[:2]}/{stored.digest}/C_0001.DAT"
    s3.client().put_object(Bucket=BUCKET, Key=key, Body=b"SAMPLES")
    with pytest.raises(RecordingStoreError, match="are not those stored"), in_bucket.opened(stored.digest):
        pass
    s3.client().delete_object(Bucket=BUCKET, Key=key)
    assert not stored.is_there()
    with pytest.raises(RecordingStoreError, match="are not those stored"):
        in_bucket.find(stored.digest)
    assert in_bucket.store(FILES).is_there(), "pulled again, it is whole again"


@pytest.mark.parametrize("name", ["../../../etc/passwd", "C_0001.CFG/C_0001.CFG", "c_0001.cfg", ".CFG"])
def test_hostile_keys_lead_nowhere(
    s3: S3Server, in_bucket: BucketStore, place: BucketPlace, name: str, tmp_path: Path
) -> None:
    digest = manifest_digest([StoredFile(name, 0, "0" * 64)])
    s3.client().put_object(Bucket=BUCKET, Key=f"{place.prefix}{digest[:2]}/{digest}/{name}", Body=b"evil")
    before = set(tmp_path.rglob("*"))
    with pytest.raises(RecordingStoreError, match=r"expected files such as|missing"):
        in_bucket.find(digest)
    assert set(tmp_path.rglob("*")) == before
    s3.client().put_object(Bucket=BUCKET, Key=f"{place.prefix}ab/notes of somebody", Body=b"mine")
    assert list(in_bucket.unknown.stored("ab")) == []


@pytest.mark.parametrize(("name", "limit"), [("MOST_FILES", 1), ("MOST_BYTES", 12)])
def test_what_is_too_much_for_a_record_is_not_fetched(
    in_bucket: BucketStore, name: str, limit: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    digest = in_bucket.store(FILES).digest
    monkeypatch.setattr(bucket, name, limit)
    monkeypatch.setattr(Bucket, "get", lambda *_: pytest.fail("it was fetched"))
    with pytest.raises(RecordingStoreError, match=r"expected at most .* found 2 and 13"):
        in_bucket.find(digest)
    assert list((tmp_path / "arriving" / "service").iterdir()) == []


def test_a_large_record_takes_little_memory(in_bucket: BucketStore, tmp_path: Path) -> None:
    content = tmp_path / "L.DAT"
    content.write_bytes(bytes(range(256)) * (20 * MB // 256))
    with in_bucket.opened(in_bucket.store({"W.CFG": b"warm", "W.DAT": b"up"}).digest):
        pass
    tracemalloc.start()
    try:
        digest = in_bucket.store({"L.CFG": b"config", "L.DAT": content}).digest
        with in_bucket.opened(digest) as entry:
            assert entry.with_name("L.DAT").stat().st_size == content.stat().st_size
        _, peak_bytes = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak_bytes < 4 * MB + 16 * CHUNK_BYTES


FAILING: dict[str, Callable[[BucketStore], object]] = {
    "store": lambda store: store.store(FILES),
    "find": lambda store: store.find("ab" * 32),
    "set aside": lambda store: store.set_aside("ab" * 32),
    "sweep": lambda store: list(store.unknown.stored("ab")),
}


@pytest.mark.parametrize("asked", FAILING)
def test_a_busy_server_is_told_and_serves_again(s3: S3Server, in_bucket: BucketStore, asked: str) -> None:
    s3.fail(Fault.BUSY)
    with pytest.raises(StoreUnreachableError, match="the store answers 503 SlowDown"):
        FAILING[asked](in_bucket)
    assert "the store answers 503 SlowDown" in (in_bucket.problem() or "")
    s3.fail(Fault.NONE)
    assert in_bucket.problem() is None
    assert in_bucket.store(FILES).is_there()


@pytest.mark.usefixtures("new_clients")
@pytest.mark.parametrize("asked", ["store", "find"])
def test_a_server_that_stalls_is_told_in_time_and_serves_again(
    s3: S3Server, in_bucket: BucketStore, asked: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    s3.fail(Fault.STALLS)
    with monkeypatch.context() as impatient:
        for name in ("ANSWER_S", "QUICK_ANSWER_S"):
            impatient.setattr(bucket_client, name, 0.5)
        began_s = time.monotonic()
        with pytest.raises(StoreUnreachableError, match="the store does not answer"):
            FAILING[asked](in_bucket)
        assert "the store does not answer" in (in_bucket.problem() or "")
        assert time.monotonic() - began_s < 30.0
    s3.fail(Fault.NONE)
    forget_clients()
    assert in_bucket.problem() is None
    assert in_bucket.store(FILES).is_there()


@pytest.mark.parametrize("fault", NONSENSE)
def test_who_answers_nonsense_keeps_nothing_and_no_recording_is_at_fault(
    s3: S3Server, in_bucket: BucketStore, fault: Fault
) -> None:
    s3.fail(fault)
    for asked in ("find", "set aside", "sweep"):
        with pytest.raises(StoreUnreachableError):
            FAILING[asked](in_bucket)
    assert in_bucket.problem() is not None
    with pytest.raises(StoreUnreachableError):
        # What a put is answered need not be read; whoever adds a row asks whether it is there.
        in_bucket.store(FILES).is_there()


@pytest.mark.parametrize("asked", FAILING)
def test_who_may_not_is_told_what_it_takes(s3: S3Server, in_bucket: BucketStore, asked: str) -> None:
    s3.fail(Fault.DENIED)
    words = r"refuses it \(AccessDenied\): expected credentials that may list, read, write and delete"
    with pytest.raises(StoreError, match=words) as told:
        FAILING[asked](in_bucket)
    assert not isinstance(told.value, StoreUnreachableError)
    assert "AccessDenied" in (in_bucket.problem() or "")
    assert SECRET not in "".join(traceback.format_exception(told.value))


def test_bytes_that_only_trickle_hang_nobody(
    s3: S3Server, in_bucket: BucketStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    digest = in_bucket.store({"S.CFF": bytes(100_000)}).digest
    s3.fail(Fault.TRICKLES)
    threads = threading.active_count()
    monkeypatch.setattr(bucket_client, "TRANSFER_S", 1.0)
    with pytest.raises(StoreUnreachableError, match="found a slower one: given up"):
        in_bucket.find(digest)
    monkeypatch.setattr(bucket_client, "TRANSFER_S", 60.0)
    s3.fail(Fault.NONE)
    wait_until(lambda: threading.active_count() <= threads)
    with in_bucket.opened(digest) as entry:
        assert entry.read_bytes() == bytes(100_000)


@pytest.mark.usefixtures("s3", "new_clients")
def test_a_server_that_is_killed_and_comes_back(
    place: BucketPlace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with serving_s3(tmp_path) as server:
        monkeypatch.setenv("AWS_ENDPOINT_URL_S3", server.url)
        store = BucketStore(place, tmp_path / "arriving")
        digest = store.store({"S.CFF": bytes(100_000)}).digest
        server.fail(Fault.TRICKLES)
        killed = threading.Timer(0.5, server.kill)
        killed.start()
        # A part of a file is no damaged recording.
        with pytest.raises(StoreUnreachableError, match=r"to end|does not answer"), store.opened(digest):
            pass
        killed.join()
        assert list((tmp_path / "arriving").iterdir()) == []
        with pytest.raises(StoreUnreachableError, match="does not answer"):
            store.store(FILES)
        assert "Connection refused" in (store.problem() or "")
        server.fail(Fault.NONE)
        server.start()
        with pytest.raises(StoreUnreachableError, match=f"expected the bucket {BUCKET}, found none: make it"):
            store.store(FILES)
        server.make_bucket()
        assert store.store(FILES).is_there()


@pytest.mark.usefixtures("s3", "new_clients")
def test_without_credentials_it_says_so(in_bucket: BucketStore, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.delenv(name)
    with pytest.raises(StoreUnreachableError, match="expected credentials such as AWS_ACCESS_KEY_ID"):
        in_bucket.store(FILES)


@pytest.mark.usefixtures("s3", "new_clients")
@pytest.mark.parametrize(
    "url",
    ["http://me:geheim@127.0.0.1:1", "http://127.0.0.1:1/?geheim", "me:geheim@minio:9000", "http://[geheim"],
)
def test_an_endpoint_with_a_secret_is_refused_and_not_told(
    in_bucket: BucketStore, url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AWS_ENDPOINT_URL_S3", url)
    with pytest.raises(StoreUnreachableError, match="expected a URL such as https://minio") as told:
        in_bucket.store(FILES)
    assert in_bucket.problem() == str(told.value)
    assert "geheim" not in "".join(traceback.format_exception(told.value))


@pytest.mark.usefixtures("s3", "new_clients")
def test_a_profile_that_is_not_there_is_told(in_bucket: BucketStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AWS_PROFILE", "nobody's")
    assert "cannot be asked: The config profile (nobody's) could not be found" in (in_bucket.problem() or "")
    monkeypatch.delenv("AWS_PROFILE")
    assert in_bucket.problem() is None


@pytest.mark.parametrize(
    ("url", "in_clear"),
    [
        ("http://minio.example:9000", True),
        ("http://10.0.0.7", True),
        ("https://minio.example:9000", False),
        ("http://localhost:9000", False),
        ("http://127.0.0.1:9000", False),
        ("http://[::1]:9000", False),
    ],
)
def test_what_others_can_read_goes_in_clear(url: str, in_clear: bool) -> None:
    require_sound(url)
    assert goes_in_clear(url) is in_clear


def test_a_bucket_answers_many_threads(in_bucket: BucketStore, place: BucketPlace) -> None:
    digests = [in_bucket.store({f"E{k}.CFF": b"%d" % k}).digest for k in range(4)]
    found: list[str] = []
    workers = [
        threading.Thread(target=lambda d=digest: found.append(BucketStore(place, None).find(d).digest))
        for digest in digests * 3
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert sorted(found) == sorted(digests * 3)
    assert [one.key for one in Bucket(place).objects("zz/")] == []


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("s3://user:secret@bucket/prefix", "without a user, a password or a host"),
        ("https://bucket.example/", "s3://BUCKET"),
        ("s3://", "s3://BUCKET"),
        ("s3://bucket/../elsewhere", "the prefix of letters"),
        ("s3://bucket/a b", "the prefix of letters"),
    ],
)
def test_what_is_no_place_is_refused(url: str, words: str) -> None:
    with pytest.raises(SettingsError, match=words) as told:
        Settings.load(None, {"recordings_url": url})
    assert "recordings_url" in str(told.value)


def test_back_ups_refuse_a_bucket_in_one_line() -> None:
    options = {"recordings_url": f"s3://{BUCKET}", "backup": {"directory": "/backups"}}
    with pytest.raises(SettingsError, match="back-ups take recordings from a folder alone"):
        Settings.load(None, options)
