"""One event uploaded in three formats is one record: the finest counts, the others are its copies."""

from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from core.machines.parameters import Motor
from core.recordings import comtrade
from core.recordings.comtrade.writer import DataFormat
from service.api import ApiContext
from service.jobs.keeping import keep_diagnosed
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.recording_store.recording import LocalFile
from service.web.app import create_site
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault
from testing.service.following import PUMP, fold_all
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS
from testing.service.real_recordings import running_record
from tests.service.api.serving import serving
from tests.service.web.pages import page, words

FORMATS: dict[str, DataFormat] = {"OSCA001": "ASCII", "OSC16B001": "BINARY", "OSC32F001": "FLOAT32"}
MOTOR: Motor = replace(REFERENCE, name=PUMP)


def brought(context: ApiContext, client: httpx.Client, folder: Path, name: str) -> str:
    """Upload the event in a format, and diagnose it as a worker does; return the recording's id."""
    record = running_record(begin_ns=NOW_NS, fault=Fault(0.05, 1))
    entry = comtrade.write(folder / name, record, revision=2013, data_format=FORMATS[name])
    files = [("files", (one.name, one.read_bytes())) for one in folder.glob(f"{name}.*")]
    response = client.post("/api/v1/recordings", data={"motor": PUMP}, files=files)
    repository = context.repository
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    made = diagnose_recording(DiagnosisTask(LocalFile(entry), MOTOR, "hcpa", "shorted-winding"))
    assert isinstance(made, Diagnosed)
    keep_diagnosed(repository, claimed, made, runner=RUNNER, time_zone=None)
    return str(response.raise_for_status().json()["id"])


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_an_event_uploaded_in_three_formats(
    context: ApiContext, tmp_path: Path, order: tuple[int, ...]
) -> None:
    names = list(FORMATS)
    site = create_site(replace(context, motors={PUMP: MOTOR}))
    with serving(site) as client:
        ids = {names[k]: brought(context, client, tmp_path, names[k]) for k in order}
        fold_all(context.repository, MOTOR)
        fine, coarser = ids.pop("OSC32F001"), set(ids.values())
        points = context.repository.condition_trend(PUMP, limit=9).items
        assert [point.recording_id for point in points] == [fine]
        trend = client.get(f"/api/v1/motors/{PUMP}/trend?quantity=mu_f").raise_for_status().json()
        assert len(trend["items"]) == 1
        document = client.get(f"/api/v1/recordings/{fine}").raise_for_status().json()
        assert set(document["copies"]) == coarser
        assert (document["copy_of"], document["reason"]) == (None, None)
        for one in coarser:
            copy = client.get(f"/api/v1/recordings/{one}").raise_for_status().json()
            assert (copy["copy_of"], copy["state"]) == (fine, "diagnosed")
            assert (
                copy["reason"] == f"a copy of recording OSC32F001 ({fine}): the same event, which counts once"
            )
            assert client.get(f"/api/v1/recordings/{one}/file").is_success
        shown = page(client.get(f"/recordings/{fine}", headers={"Accept": "text/html"}))
        facts = dict(zip(words(shown, "#about + dl dt"), words(shown, "#about + dl dd"), strict=True))
        assert facts["Copies"].startswith(("OSCA001, OSC16B001", "OSC16B001, OSCA001"))
        (one, *_) = coarser
        about = page(client.get(f"/recordings/{one}", headers={"Accept": "text/html"}))
        assert about.cssselect(f"#about + dl a[href='/recordings/{fine}']")
        deleted = client.delete(f"/api/v1/recordings/{fine}", params={"reason": "of another motor"})
        assert deleted.is_success
        assert context.repository.claim_job(now_ns=2**62, runner=RUNNER) is not None
