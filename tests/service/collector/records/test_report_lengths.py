"""How long a relay's records are, over real MMS: told by API, page and command, with what to set."""

import time
from dataclasses import replace
from pathlib import Path

import pytest

from ied_sim.relay.event_recorder import RecorderSettings
from service.api import ApiContext
from service.cli.app import main
from service.storage.states import RecordingRequestState
from service.web.app import create_site
from testing.relays.simulated import scenario_of, simulated
from testing.service.plants import motor
from testing.waiting import eventually
from tests.service.api.serving import serving
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.scripted_relay import NAME
from tests.service.collector.session.test_simulated_relays import of
from tests.service.collector.triggers.test_series import RUNNER, diagnose_all

CYCLE_S = 1 / 50.0


@pytest.mark.parametrize(
    ("cycles", "before", "told"),
    [(15, 4, ("set LER := 64", "set PRE := 20")), (30, 10, ("set LER := 64",)), (64, 20, ())],
)
def test_the_length_of_a_relays_records_and_what_to_set(
    bench: Bench,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    cycles: int,
    before: int,
    told: tuple[str, ...],
) -> None:
    recorder = RecorderSettings(
        sample_rate_hz=1_600.0,
        pre_trigger_s=before * CYCLE_S,
        post_trigger_s=(cycles - before) * CYCLE_S,
        capacity=4,
    )
    bench.repository.register_runner(RUNNER, installation="here", now_ns=time.time_ns(), max_attempts=3)
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2", recorder=recorder)) as served:
        here = of(bench, served, "EVENTS")
        with here.session() as session:
            request = here.request()
            session.wake()
            assert eventually(lambda: here.requested(request).state is RecordingRequestState.FETCHED, 20)
    diagnose_all(here)
    context = ApiContext(
        here.settings, here.repository, here.store, motors={MOTOR: replace(motor(MOTOR), name=MOTOR)}
    )
    with serving(create_site(context)) as client:
        length = client.get(f"/api/v1/ieds/{NAME}").json()["report_length"]
        page = client.get(f"/relays/{NAME}", headers={"Accept": "text/html"}).text
        assert main(["relay", NAME, "--url", str(client.base_url)]) == 0
    printed = " ".join(capsys.readouterr().out.replace("\N{BOX DRAWINGS LIGHT VERTICAL}", " ").split())
    assert length["cycles"] == pytest.approx(cycles, abs=0.1)
    assert length["pre_trigger_s"] == pytest.approx(before * CYCLE_S, abs=0.001)
    assert length["longest_cycles"] == 64
    assert len(length["advice"]) == len(told)
    assert f"({cycles} cycles)" in page
    assert f"({cycles} cycles)" in printed
    for words in told:
        assert words in " ".join(length["advice"])
        assert words in page
        assert words in printed
