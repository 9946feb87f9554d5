import io
import zipfile
from collections.abc import Collection
from dataclasses import replace

import httpx
import pytest

from core.diagnosis.search import METHODS
from core.machines.stator_models import MODELS
from core.time_stamps import nanoseconds
from service.api import ApiContext, create_app
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import RemoteRecord
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.small_record import CFG, DAT, IA
from tests.core.recordings.cev_files import REPORT
from tests.core.recordings.comtrade_files import RECORD_1999
from tests.service.api.serving import serving

FILES = {"EVENT.CFG": CFG, "EVENT.DAT": DAT}


def upload(
    client: httpx.Client, files: dict[str, bytes], motor: str = "PUMP-A1"
) -> tuple[int, dict[str, object]]:
    response = client.post(
        "/api/v1/recordings",
        data={"motor": motor},
        files=[("files", (name, content)) for name, content in files.items()],
    )
    document = response.json()
    assert isinstance(document, dict)
    if response.is_success:
        assert response.headers["location"] == f"/api/v1/recordings/{document['id']}"
    return response.status_code, document


@pytest.fixture
def recording(client: httpx.Client) -> str:
    return str(upload(client, FILES)[1]["id"])


def test_an_upload_is_stored_once_and_queued(context: ApiContext, repository: Repository) -> None:
    woken: list[str] = []
    app = create_app(replace(context, on_new_job=lambda: woken.append("now")))
    with serving(app) as client:
        status, document = upload(client, FILES)
        again, same = upload(client, FILES)
    assert (status, again) == (201, 200)
    assert document == same
    assert (document["source"], document["state"], document["name"]) == ("upload", "fetched", "EVENT")
    assert document["diagnosis"] is None
    assert repository.claim_job(now_ns=2**62, runner=RUNNER) is not None
    assert repository.claim_job(now_ns=2**62, runner=RUNNER) is None
    assert woken


def test_an_event_report_is_a_recording(client: httpx.Client) -> None:
    status, document = upload(client, {"C4_10000.TXT": REPORT.content()})
    assert status == 201
    assert [file["name"] for file in document["files"]] == ["C4_10000.CEV"]  # type: ignore[attr-defined]
    waveform = client.get(f"/api/v1/recordings/{document['id']}/waveform").json()
    assert [channel["name"] for channel in waveform["channels"]] == ["IA", "IB", "VAB", "VC", "FREQ"]
    assert waveform["trigger_time"].startswith("2024-11-21T06:30:00.25")


def test_a_table_is_a_recording(client: httpx.Client) -> None:
    rows = (f"{k / 4000:.5f},{k % 80},{k % 40}" for k in range(400))
    content = "\n".join(("time,IA,IB", *rows)).encode()
    status, document = upload(client, {"pump_2026-01-31T12-00-00.csv": content})
    assert (status, document["name"]) == (201, "PUMP_2026-01-31T12-00-00")
    waveform = client.get(f"/api/v1/recordings/{document['id']}/waveform").raise_for_status().json()
    assert [channel["name"] for channel in waveform["channels"]] == ["IA", "IB"]
    assert waveform["start_time"].startswith("2026-01-31T12:00:00")


def test_a_gap_shows_in_the_waveform(client: httpx.Client) -> None:
    gap = RECORD_1999.but(stamps=(0, 1000, 2000, 9000, 10_000))
    files = {"GAP.CFG": gap.configuration().encode(), "GAP.DAT": gap.data()}
    _, document = upload(client, files)
    waveform = client.get(f"/api/v1/recordings/{document['id']}/waveform").json()
    assert waveform["time_s"] == pytest.approx([0, 0.001, 0.002, 0.009, 0.010])


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ({"EVENT.CFG": CFG}, "the .DAT file that belongs to the .CFG"),
        ({"EVENT.DAT": DAT}, "exactly one file"),
        ({"ONE.CFG": CFG, "TWO.DAT": DAT}, "the same name, found 'ONE.CFG' and 'TWO.DAT'"),
        ({"EVENT.EXE": b"MZ"}, "expected a file ending in"),
        ({f"E{i}.CFF": b"" for i in range(5)}, "at most 4 files"),
    ],
)
def test_what_is_no_recording_is_refused(client: httpx.Client, files: dict[str, bytes], message: str) -> None:
    status, problem = upload(client, files)
    assert status == 422
    assert message in str(problem["detail"])


def test_an_upload_names_its_motor(client: httpx.Client) -> None:
    status, problem = upload(client, FILES, motor="NOPE")
    assert (status, problem["detail"]) == (404, "there is no motor 'NOPE'")
    assert client.post("/api/v1/recordings", files={"files": ("E.CFF", b"x")}).status_code == 422


def test_too_large_an_upload(client: httpx.Client) -> None:
    assert upload(client, {"E.CFF": b"x" * 200_001})[0] == 413

    beginning = b'--b\r\nContent-Disposition: form-data; name="files"; filename="E.CFF"\r\n\r\n'
    unannounced = client.post(
        "/api/v1/recordings",
        content=iter([beginning, *[b"x" * 100_000] * 3]),
        headers={"Content-Type": "multipart/form-data; boundary=b"},
    )
    assert unannounced.status_code == 413


def test_details_with_files_and_diagnosis(
    client: httpx.Client, repository: Repository, recording: str
) -> None:
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS + SECOND_NS, runner=RUNNER
    )
    document = client.get(f"/api/v1/recordings/{recording}").json()
    assert document["diagnosis"] == findings_of(fault()).as_dict()
    assert [(file["name"], file["size_bytes"]) for file in document["files"]] == [
        ("EVENT.CFG", len(CFG)),
        ("EVENT.DAT", len(DAT)),
    ]


def test_a_recording_can_be_diagnosed_again(
    client: httpx.Client, repository: Repository, recording: str
) -> None:
    url = f"/api/v1/recordings/{recording}/diagnoses"
    accepted = client.post(url, json={"method": "hcpa", "model": "shorted-winding"})
    assert accepted.status_code == 202
    run = client.get(accepted.headers["location"]).json()
    assert run == accepted.json()
    assert (run["method"], run["model"], run["state"], run["result"]) == (
        "hcpa",
        "shorted-winding",
        "queued",
        None,
    )
    usual, only_searched, only_modelled = (
        client.post(url, json=wanted).json()
        for wanted in ({}, {"method": "hcpa"}, {"model": "split-winding"})
    )
    assert (usual["method"], usual["model"]) == ("evidence", "coil")
    assert (only_searched["method"], only_searched["model"]) == ("hcpa", "split-winding")
    assert (only_modelled["method"], only_modelled["model"]) == ("hybrid", "split-winding")
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    runs = client.get(url).json()["items"]
    assert len(runs) == 5
    assert [run["result"] for run in runs if run["state"] == "done"] == [findings_of(fault()).as_dict()]


@pytest.mark.parametrize(("field", "known"), [("method", METHODS), ("model", MODELS)])
def test_a_diagnosis_the_core_does_not_know_leaves_the_recording_as_it_is(
    client: httpx.Client, repository: Repository, recording: str, field: str, known: Collection[str]
) -> None:
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    before = client.get(f"/api/v1/recordings/{recording}").json()
    refused = client.post(f"/api/v1/recordings/{recording}/diagnoses", json={field: "guess"})
    assert refused.status_code == 422
    assert refused.headers["content-type"] == "application/problem+json"
    (error,) = refused.json()["errors"]
    assert error["location"] == f"body.{field}"
    assert all(name in error["message"] for name in known)
    assert client.get(f"/api/v1/recordings/{recording}").json() == before
    assert repository.claim_job(now_ns=2**62, runner=RUNNER) is None


def test_files_come_back_as_they_came(client: httpx.Client, recording: str) -> None:
    response = client.get(f"/api/v1/recordings/{recording}/file")
    assert response.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(response.content)) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == FILES


def test_waveform(client: httpx.Client, recording: str) -> None:
    url = f"/api/v1/recordings/{recording}/waveform"
    whole = client.get(url).json()
    assert (whole["samples"], whole["sample_rate_hz"]) == (8, 1000.0)
    assert whole["start_time"] == "2026-11-21T06:00:00.000000000Z"
    assert whole["trigger_time"] == "2026-11-21T06:00:00.002000000Z"
    assert whole["time_s"] == pytest.approx([i / 1000 for i in range(8)])
    ia = whole["channels"][0]
    assert (ia["name"], ia["phase"], ia["unit"], ia["quantity"]) == ("IA", "a", "A", "current")
    assert ia["minimum"] == ia["maximum"] == pytest.approx([value / 100 for value in IA])

    few = client.get(url, params={"points": 2}).json()
    assert few["time_s"] == pytest.approx([0.0, 0.004])
    assert few["channels"][0]["maximum"] == pytest.approx([9.0, 2.0])
    assert few["channels"][0]["minimum"] == pytest.approx([0.0, -1.0])


def test_a_waveform_has_the_time_that_its_diagnosis_found(
    client: httpx.Client, repository: Repository, recording: str
) -> None:
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    utc_ns = nanoseconds("2026-11-21T05:00:00.002Z")
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=utc_ns, now_ns=NOW_NS, runner=RUNNER
    )
    waveform = client.get(f"/api/v1/recordings/{recording}/waveform").json()
    assert waveform["trigger_time"] == "2026-11-21T05:00:00.002000000Z"
    assert waveform["start_time"] == "2026-11-21T05:00:00.000000000Z"


def test_a_record_that_cannot_be_read_or_is_not_there_yet(
    client: httpx.Client, repository: Repository
) -> None:
    broken = upload(client, {"EVENT.CFG": CFG, "EVENT.DAT": DAT[:40]})[1]["id"]
    response = client.get(f"/api/v1/recordings/{broken}/waveform")
    assert response.status_code == 409
    assert "cannot be read: EVENT" in response.json()["detail"]
    announced = repository.announce_recording("A1_SEL710", "PUMP-A1", RemoteRecord("X", 1, 1), now_ns=NOW_NS)
    for part in ("waveform", "file"):
        response = client.get(f"/api/v1/recordings/{announced.id}/{part}")
        assert (response.status_code, response.json()["detail"]) == (
            409,
            "the recording is announced, not stored",
        )
    assert client.post(f"/api/v1/recordings/{announced.id}/diagnoses").status_code == 409


def test_a_damaged_store_is_an_error_of_the_service(
    client: httpx.Client, context: ApiContext, repository: Repository, recording: str
) -> None:
    digest = repository.recording(recording).digest
    assert digest is not None
    assert isinstance(context.store, FolderStore)
    context.store.entry(digest).write_bytes(b"changed")
    response = client.get(f"/api/v1/recordings/{recording}/file")
    assert response.status_code == 500
    assert "are not those stored" in response.json()["detail"]
