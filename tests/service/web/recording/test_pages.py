"""The pages of recordings: what they say, for whom, and of recordings that are odd."""

import re
from collections.abc import Iterator
from dataclasses import replace

import httpx
import numpy as np
import pytest
from lxml import html

from core.diagnosis.causes import Cause
from core.diagnosis.verdict import Hypothesis
from core.recordings import Channel, Digitals, Quantity
from service.api import ApiContext
from service.web.app import create_site
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.real_recordings import add_recording, running_record
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SWINGING_LOAD,
    ExaminedRecordings,
)
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import serving
from tests.service.web.pages import HOSTILE, addresses, page, words

HOUR_NS = 3600 * SECOND_NS
MISSING = "00000000-0000-0000-0000-000000000000"


@pytest.fixture
def recordings(context: ApiContext) -> list[str]:
    """A healthy recording, and an hour later one with shorted turns in phase b."""
    records = [running_record(), running_record(begin_ns=NOW_NS + HOUR_NS, fault=Fault(0.05, 1))]
    return [add_recording(context.repository, context.store, record) for record in records]


@pytest.fixture
def looking(context: ApiContext) -> Iterator[httpx.Client]:
    """Somebody who may do everything, of a service that knows its motors."""
    with serving(create_site(replace(context, motors={"PUMP-A1": REFERENCE}))) as client:
        client.headers["Accept"] = "text/html,*/*;q=0.8"
        yield client


def test_a_recording_says_what_it_found_and_how_sure_that_is(
    looking: httpx.Client, recordings: list[str]
) -> None:
    document = page(looking.get(f"/recordings/{recordings[1]}"))
    assert words(document, "#said") == ["fault"]
    (said,) = words(document, ".said")
    number = r"([\d.]+)"
    interval = rf"\(95 % interval {number} to {number} %\)\."
    told = re.fullmatch(rf"Shorted turns in phase b: {number} % of the phase's turns {interval}", said)
    assert told is not None, said
    level, low, high = map(float, told.groups())
    assert level == pytest.approx(5.0, rel=0.1)  # axis and leakage of the turns are not known
    assert low < 5.0 < high
    facts = dict(zip(words(document, "dl.facts dt"), words(document, "dl.facts dd"), strict=True))
    load, low, high = map(float, re.findall(r"([\d.]+) (?:%|to)", facts["Load"].replace("95 % interval", "")))
    assert load == pytest.approx(50.0, abs=2.0)  # what the turns draw depends on their leakage
    assert low < 50.0 < high
    assert "in phase b" in facts["Fitted"]
    assert facts["From"] == "an upload"
    assert words(document, "section[aria-labelledby=parameters] li")
    (passed,) = document.cssselect("section[aria-labelledby=quality] details:not([open])")
    assert words(passed, "summary")[0].startswith("All ")


@pytest.mark.parametrize(
    ("probabilities", "where"),
    [
        ((0.717, 0.003, 0.28), "in phase a (72 %) or c (28 %): "),
        (None, "Shorted turns: "),  # of a motor with slip rings
    ],
)
def test_a_phase_that_is_not_named_alone_stands_with_the_other_one(
    looking: httpx.Client,
    context: ApiContext,
    probabilities: tuple[float, float, float] | None,
    where: str,
) -> None:
    turns = Hypothesis(Cause.SHORTED_TURNS, 0.99, 30.0, "equivalent level 5.1%")
    open_phase = replace(
        fault(),
        theta_f=None,
        reasons=("shorted turns", "the turns lie in coils of the axis +20 degrees of phase a (93%)"),
        phase_probabilities=probabilities,
        hypotheses=(turns,),
    )
    recording = ExaminedRecordings(context.repository, context.store).add(BROKEN_ROTOR, diagnosis=open_phase)
    document = page(looking.get(f"/recordings/{recording}"))
    (said,) = words(document, ".said")
    assert where in said
    assert words(document, "section[aria-labelledby=parameters] li")[1].startswith("the turns lie in coils")
    facts = " ".join(words(document, "section[aria-labelledby=parameters] dd"))
    assert "level " in facts
    assert "in phase" not in facts, "the fit has a phase, but none is named"
    shown = looking.get(f"/api/v1/recordings/{recording}").json()["diagnosis"]
    assert shown["hypotheses"] == [turns.as_dict()]
    assert shown["phase_probabilities"] == (None if probabilities is None else [*probabilities])


def test_rotor_and_supply_are_told_beside_the_stator(
    looking: httpx.Client, recordings: list[str], context: ApiContext
) -> None:
    (first, _) = context.repository.rotor_trend("PUMP-A1", limit=10).items
    document = page(looking.get(f"/recordings/{recordings[0]}"))
    told = " ".join(words(document, "section[aria-labelledby=rotor]"))
    assert first.finding.reasons[0] in told
    assert "unbalance" in " ".join(words(document, "section[aria-labelledby=supply] li"))
    stored = context.repository.current_diagnosis(recordings[0])
    assert stored is not None
    assert stored.document["rotor"] == first.finding.as_dict()
    shown = looking.get(f"/api/v1/recordings/{recordings[0]}").json()["diagnosis"]
    for part in ("eccentricity", "pulsation"):
        assert shown[part] == stored.document[part]
        assert shown[part]["load_torque"] is not None or shown[part]["reasons"]


def test_air_gap_and_load_are_told_beside_the_rotor(looking: httpx.Client, context: ApiContext) -> None:
    recording = ExaminedRecordings(context.repository, context.store).add(
        BROKEN_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD
    )
    document = page(looking.get(f"/recordings/{recording}"))
    assert words(document, "section[aria-labelledby=rotor] p") == [
        "Fault, asymmetry -29.0 dB [-31.0..-27.5]; detection limit -52.0 dB."
    ]
    told = zip(
        words(document, "section[aria-labelledby=rotor] dt"),
        words(document, "section[aria-labelledby=rotor] dd"),
        strict=True,
    )
    facts = dict(told)
    assert facts["Air gap"].startswith("permeance ripples by 5.25 %")
    assert facts["Load"].startswith("torque swings by 6.25 % of the rated one at 4.12 Hz")


def test_waveforms_phasors_spectrum_and_states_are_there_without_a_script(
    looking: httpx.Client, recordings: list[str]
) -> None:
    document = page(looking.get(f"/recordings/{recordings[1]}"))
    names = [figure.get("data-chart-name") for figure in document.cssselect("figure.chart")]
    assert names == ["Voltages", "Currents", "States that change", "Spectrum of the currents"]
    tables = document.cssselect("figure.chart table")
    assert all(30 <= len(table.cssselect("tbody tr")) <= 60 for table in tables[:2])
    assert words(document, ".phasors table tbody th")[:6] == ["Va", "Vb", "Vc", "Ia", "Ib", "Ic"]
    assert document.cssselect(".phasor-picture svg title")
    assert words(document, ".states li")[1].startswith("50P1: 0, changes at 0.2000 s, 0.2500 s")
    (spectrum,) = document.cssselect("section[aria-labelledby=spectrum-heading]")
    assert "does not resolve the sidebands of broken bars" in spectrum.text_content()
    assert "(1−2s)f" not in spectrum.text_content(), "the leakage of the supply's line is no broken bar"


def test_the_cursor_is_part_of_the_address(looking: httpx.Client, recordings: list[str]) -> None:
    document = page(looking.get(f"/recordings/{recordings[0]}?at_s=0.1"))
    (picture,) = words(document, ".phasor-picture svg title")
    assert picture.startswith("Phasors at 0.0999 s. Va 219")
    part = page(looking.get(f"/recordings/{recordings[0]}/phasors?at_s=0.4"))
    assert words(part, "svg title")[0].startswith("Phasors at 0.3999 s")


def test_one_goes_from_recording_to_recording(looking: httpx.Client, recordings: list[str]) -> None:
    first, second = (page(looking.get(f"/recordings/{one}")) for one in recordings)
    assert addresses(first, "a[rel=next]") == [f"/recordings/{recordings[1]}"]
    assert not addresses(first, "a[rel=prev]")
    assert addresses(second, "a[rel=prev]") == [f"/recordings/{recordings[0]}"]
    assert not addresses(second, "a[rel=next]")
    downloads = addresses(second, "a[download]")
    assert downloads == [f"/api/v1/recordings/{recordings[1]}/{what}" for what in ("file", "csv")]
    assert all(looking.get(one).is_success for one in downloads)


def test_the_model_leaves_what_the_diagnosis_said(looking: httpx.Client, recordings: list[str]) -> None:
    part = page(looking.get(f"/recordings/{recordings[1]}/model"))
    assert "as the diagnosis says" in words(part, "#model p")[0]
    assert len(part.cssselect("figure.chart table tbody tr")) > 30


def test_other_parameters_than_those_of_the_diagnosis_are_told(
    context: ApiContext, recordings: list[str]
) -> None:
    parameters = replace(REFERENCE.parameters, stator_leakage_H=0.05)
    motors = {"PUMP-A1": replace(REFERENCE, parameters=parameters)}
    with serving(create_site(replace(context, motors=motors))) as client:
        part = page(client.get(f"/recordings/{recordings[1]}/model"))
    assert "diagnose again" in words(part, "#model .message")[0]


def test_two_recordings_side_by_side(looking: httpx.Client, recordings: list[str]) -> None:
    document = page(looking.get(f"/recordings/{recordings[1]}?with={recordings[0]}"))
    (section,) = document.cssselect("section[aria-labelledby=compare]")
    rows = {row[0]: row[1:] for row in (words(one, "th, td") for one in section.cssselect("tbody tr")[:12])}
    assert rows["verdict"][:2] == ["fault", "healthy"]
    here, there, more = (float(one.split()[0]) for one in rows["fault level"])
    assert here == pytest.approx(5.0, rel=0.1)
    assert more == pytest.approx(here - there, abs=0.02)
    assert float(rows["I2"][0].split()[0]) > 10 * float(rows["I2"][1].split()[0])
    assert "Currents of both" in str(section.cssselect("figure.chart")[0].get("data-chart-name"))
    assert looking.get(f"/recordings/{recordings[1]}?with={MISSING}").status_code == 404
    choosing = page(looking.get(f"/recordings?motor=PUMP-A1&with={recordings[1]}"))
    assert f"/recordings/{recordings[1]}?with={recordings[0]}#compare" in addresses(choosing, "td a")


def test_a_recording_of_another_motor_is_not_compared(
    looking: httpx.Client, context: ApiContext, recordings: list[str]
) -> None:
    other = add_recording(
        context.repository,
        context.store,
        running_record(begin_ns=NOW_NS + 2 * HOUR_NS),
        name="FAN-A2",
        diagnosed=False,
    )
    assert looking.get(f"/recordings/{recordings[0]}?with={other}").status_code == 404


def test_the_list_filters_by_address(looking: httpx.Client, recordings: list[str]) -> None:
    document = page(looking.get("/recordings"))
    assert addresses(document, "tbody th a") == [f"/recordings/{one}" for one in reversed(recordings)]
    assert words(document, "tbody .state") == ["fault", "healthy"]
    assert not words(page(looking.get("/recordings?motor=FAN-A2")), "tbody tr")
    assert not words(page(looking.get("/recordings?show=fetched")), "tbody tr")
    assert len(words(page(looking.get("/recordings?show=running")), "tbody tr")) == 2
    assert looking.get("/recordings?motor=nobody").status_code == 404


def test_a_list_of_many_has_pages(looking: httpx.Client, context: ApiContext) -> None:
    for number in range(60):
        stored = context.store.store({"E.CFF": f"{number}".encode()})
        context.repository.add_recording(stored, motor="FAN-A2", now_ns=NOW_NS + number * SECOND_NS)
    first = page(looking.get("/recordings?motor=FAN-A2"))
    assert len(first.cssselect("tbody tr")) == 50
    second = page(looking.get(addresses(first, "a[rel=next]")[0]))
    assert len(second.cssselect("tbody tr")) == 10
    assert not addresses(second, "a[rel=next]")


def test_files_are_brought_with_a_form(looking: httpx.Client, context: ApiContext) -> None:
    files = [("files", ("E.CFG", CFG)), ("files", ("E.DAT", DAT))]
    answer = looking.post("/recordings", data={"motor": "PUMP-A1"}, files=files, follow_redirects=False)
    assert answer.status_code == 303
    assert answer.headers["location"].endswith("done=recording-added")
    document = page(looking.get(answer.headers["location"]))
    assert "waits for its diagnosis" in document.text_content()
    again = looking.post("/recordings", data={"motor": "PUMP-A1"}, files=files, follow_redirects=False)
    assert again.headers["location"].endswith("done=recording-known")
    field = 'Content-Disposition: form-data; name="%s"%s\r\n\r\n%s\r\n--x'
    empty = (
        "--x\r\n"
        + field % ("motor", "", "PUMP-A1")
        + "\r\n"
        + field % ("files", '; filename=""', "")
        + "--\r\n"
    )
    head = {"Content-Type": "multipart/form-data; boundary=x"}
    for answer, why in (
        (looking.post("/recordings", data={"motor": "PUMP-A1"}, files=files[:1]), ".DAT"),
        (looking.post("/recordings", content=empty, headers=head), "choose the files"),
    ):
        assert answer.status_code == 422
        assert "body.files" not in answer.text
        form = html.fromstring(answer.text)
        assert why in words(form, "#refused")[0], "beside the field"
        assert words(form, "form[data-upload] option[selected]") == ["PUMP-A1"], "what was chosen is kept"
    wrong = looking.post("/recordings", data={"motor": "PUMP-A1"}, files=[("files", ("E.EXE", b"x"))])
    assert wrong.status_code == 422
    assert "expected a file ending in" in wrong.text


def test_another_diagnosis_is_queued(looking: httpx.Client, recordings: list[str]) -> None:
    answer = looking.post(f"/recordings/{recordings[0]}/diagnoses", follow_redirects=False)
    assert answer.headers["location"] == f"/recordings/{recordings[0]}?done=diagnosis-queued"
    jobs = looking.get(f"/api/v1/recordings/{recordings[0]}/diagnoses").json()["items"]
    assert [job["state"] for job in jobs] == ["queued", "done"]


def test_a_recording_without_what_is_needed_says_so(looking: httpx.Client, context: ApiContext) -> None:
    record = running_record()
    bare = replace(record, samples=record.samples[3:], channels=record.channels[3:], digitals=None)
    only_voltages = add_recording(context.repository, context.store, bare, diagnosed=False)
    document = page(looking.get(f"/recordings/{only_voltages}"))
    assert words(document, ".said") == ["It waits for its diagnosis."]
    assert "There are no phasors here" in words(document, ".phasors p")[0]
    assert "There is no spectrum" in document.text_content()
    assert "The recording has no states." in document.text_content()
    part = page(looking.get(f"/recordings/{only_voltages}/model"))
    assert words(part, "#model p") == [
        "The model's currents cannot be drawn: the recording is not diagnosed yet."
    ]


def test_files_that_cannot_be_read_are_told_and_still_downloaded(
    looking: httpx.Client, context: ApiContext
) -> None:
    stored = context.store.store({"E.CFF": b"not a recording"})
    added = context.repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording
    document = page(looking.get(f"/recordings/{added.id}"))
    assert any("The samples cannot be shown" in told for told in words(document, ".message.bad"))
    assert addresses(document, "a[download]") == [f"/api/v1/recordings/{added.id}/file"]
    part = page(looking.get(f"/recordings/{added.id}/phasors"))
    assert "There are no phasors here" in words(part, "p")[0]
    assert looking.get(f"/recordings/{MISSING}").status_code == 404


def test_hostile_names_of_channels_states_and_files_stay_words(
    looking: httpx.Client, context: ApiContext
) -> None:
    record = running_record()
    spare = Channel(HOSTILE, Quantity.OTHER, None, HOSTILE[:20], 10.0)
    assert record.digitals is not None
    odd = replace(
        record,
        channels=(*record.channels, spare),
        samples=np.vstack([record.samples, record.samples[:1]]),
        digitals=Digitals((HOSTILE, "</script><b>"), record.digitals.packed),
        station=HOSTILE,
    )
    recording = add_recording(context.repository, context.store, odd, diagnosed=False)
    answer = looking.get(f"/recordings/{recording}")
    document = page(answer)
    assert "<script>alert" not in answer.text
    assert "</script><b>" not in answer.text
    assert any(HOSTILE in state for state in words(document, ".states li"))
    part = looking.get(f"/recordings/{recording}/phasors?at_s=0.2")
    assert "<script>alert" not in part.text


def test_a_list_of_what_there_is_not_is_refused(looking: httpx.Client) -> None:
    assert looking.get("/recordings", params={"show": "nope"}).status_code == 422


@pytest.mark.parametrize("query", ["at_s=nan", "at_s=1e999", "with=x", "at_s=x"])
def test_addresses_that_mean_nothing_are_refused(
    looking: httpx.Client, recordings: list[str], query: str
) -> None:
    assert looking.get(f"/recordings/{recordings[0]}?{query}").status_code == 422
