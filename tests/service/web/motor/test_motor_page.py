"""The page of a motor: what it says, what it draws, and what its forms do."""

import json
import re
import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import pytest
from lxml import html

from core.condition.events import Event, EventKind
from core.condition.kinds import BESIDE_STATOR, Kind, State
from core.condition.verdict.condition import Condition as Judged
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.api.conditions.schemas import Condition
from service.condition.wording import KINDS, finding
from service.notifications.trends import trend_drawing
from service.plant import MeteredQuantity
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, ConditionPoint, RelayEvent, Role, Sample
from service.storage.records.alarms import AlarmPlace, AlarmSpec
from service.storage.records.history import ThinnedTrend
from service.storage.states import AlarmKind, RelayEventKind
from service.web.motor.trend import trend_chart
from testing.service.accounts import token_of
from testing.service.conditions import DRIFTING, FAULT, HEALTHY
from testing.service.starts import RecordedStarts
from tests.service.web.motor.recorded import MOTOR, Shown, know, record
from tests.service.web.pages import HOSTILE, addresses, page, words

HERE = f"/motors/{MOTOR}"
STATOR, SUPPLY, RECORDINGS, LOGBOOK, NAMEPLATE = (
    f"{HERE}/{tab}" for tab in ("stator", "supply", "recordings", "logbook", "nameplate")
)
ADA = Actor("ada", "::1")


def chart(document: html.HtmlElement) -> Any:
    (found,) = document.cssselect("#trend-data")
    return json.loads(found.text_content())


def forms(document: html.HtmlElement) -> set[str]:
    """The last words of where the motor's forms lead."""
    return {one.rpartition("/")[2] for one in addresses(document, f'form[action^="{HERE}"]')}


def test_one_sentence_says_what_how_bad_how_sure_since_when_and_what_to_do(shown: Shown) -> None:
    client, repository = shown.client, shown.repository
    entry = repository.condition(MOTOR)
    assert entry.state is State.FAULT
    assert entry.mu_f is not None

    document = page(client.get(HERE))

    (sentence,) = words(document, "#verdict .sentence")
    assert sentence.startswith("fault ")
    assert "shorted turns" in sentence.lower()
    assert f"{100 * entry.mu_f:.2f} % of the turns in all (" in sentence
    assert "with 95 % confidence" in sentence
    assert "since 20" in sentence
    (advice,) = words(document, "#verdict .advice")
    assert advice.startswith("What to do: Check")
    assert "Stop the motor at the next opportunity" in advice
    text = " ".join(words(document, "#verdict"))
    assert re.search(r"Latest valid record \d+ (minutes|hours) ago", text)
    assert "The reference has 40 records" in text
    assert words(document, "#why li")


def test_a_motor_without_records_says_so_in_every_part(client: httpx.Client, repository: Repository) -> None:
    know(repository)
    document = page(client.get(HERE))
    assert words(document, "#verdict .sentence") == ["unknown Nothing is known of its windings yet."]
    for address, expected in (
        (HERE, "There is no valid record yet"),
        (HERE, "no trend"),
        (HERE, "No alarm of this motor is open"),
        (HERE, "The relay told no measured values"),
        (SUPPLY, "The relay told no measured values"),
        (RECORDINGS, "has not made a record of this motor yet"),
        (LOGBOOK, "Nothing was written of this motor yet"),
        (STATOR, "Nothing was judged yet"),
        (f"{HERE}/rotor", "No record tells of the rotor yet"),
        (f"{HERE}/load", "Nothing was metered in this time"),
        (f"{HERE}/starts", "No start of this motor is known yet"),
        (NAMEPLATE, "No record tells of the parameters yet"),
    ):
        assert expected in page(client.get(address)).text_content(), address
    assert len(page(client.get(STATOR)).cssselect("#pictures svg")) == 2


def test_the_strip_has_a_line_of_each_part_that_leads_to_its_tab(shown: Shown) -> None:
    document = page(shown.client.get(f"{HERE}?days=30"))
    lines = words(document, "#parts li")
    names = ["Stator", "Rotor", "Supply", "Load", "Measurement", "Data"]
    assert [line.split()[0] for line in lines] == names
    assert lines[0] == "Stator fault shorted turns in phase " + lines[0][-1]
    assert lines[-1].startswith("Data healthy Latest valid record ")
    tabs = ["stator", "rotor", "supply", "load", "nameplate", "recordings"]
    assert addresses(document, "#parts li a") == [f"{HERE}/{tab}?days=30" for tab in tabs]
    for address in addresses(document, f'nav[aria-label="{MOTOR}"] a'):
        tab = page(shown.client.get(address))
        assert words(tab, "h1") == [MOTOR]
        assert addresses(tab, f'nav[aria-label="{MOTOR}"] [aria-current=page]') == [address]
        assert words(tab, ".spans [aria-current]") in (["30 days"], [])


def test_a_motor_that_no_service_has_read_yet_has_a_page(client: httpx.Client) -> None:
    assert client.get("/motors/FAN-A2").status_code == 200
    assert "has not read the motors file" in client.get("/motors/FAN-A2/nameplate").text
    assert client.get("/motors/NO-SUCH").status_code == 404


def test_a_condition_that_is_old_is_told_so_beside_the_fault(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    record(repository, store, ended_ns=time.time_ns() - 30 * NANOSECONDS_PER_DAY)
    (sentence,) = words(page(client.get(HERE)), "#verdict .sentence")
    assert sentence.startswith("fault no recent record ")


def test_the_trend_has_levels_intervals_limits_and_what_happened(shown: Shown) -> None:
    client, repository = shown.client, shown.repository
    now_ns = time.time_ns()
    told_ns = now_ns - 20 * 3600 * NANOSECONDS_PER_SECOND
    repository.add_event(MOTOR, Event(told_ns, EventKind.NOTE, "greased"), by=ADA, now_ns=now_ns)

    drawn = chart(page(client.get(HERE)))

    series = {one["label"]: one for one in drawn["series"]}
    assert set(series) >= {"95 % interval", "level", "fault"}
    levels = series["level"]["values"]
    points = repository.condition_trend(MOTOR, limit=1000).items
    assert levels == pytest.approx([100 * (one.mu_f or 0.0) for one in points], rel=1e-3, abs=1e-6)
    high = points[-1].mu_f_ci95_high or 0.0
    assert series["95 % interval"]["high"][-1] == pytest.approx(100 * high, rel=1e-3)
    assert drawn["limits"][0]["label"] == "motor's limit 0.50 %"
    assert drawn["x"]["to"] == pytest.approx(time.time(), abs=60.0), "silence until now is to be seen"
    marks = [(one["label"], one["x"]) for one in drawn["marks"]]
    assert marks == [("note", pytest.approx(told_ns / 1e9, abs=0.01))]


def test_the_picture_in_a_mail_shows_what_the_chart_shows(shown: Shown) -> None:
    at_ns = time.time_ns() - 20 * 3600 * NANOSECONDS_PER_SECOND
    note = Event(at_ns, EventKind.NOTE, "greased")
    shown.repository.add_event(MOTOR, note, by=ADA, now_ns=time.time_ns())
    drawn = chart(page(shown.client.get(HERE)))
    svg = trend_drawing(shown.repository, MOTOR, "UTC")
    assert svg is not None
    told = html.fromstring(svg.encode()).xpath("//*[local-name()='text']/text()")
    assert drawn["limits"][0]["label"] == "motor's limit 0.50 %"
    assert "motor's limit 0.5 %" in told
    assert drawn["marks"][-1]["label"] == "note"
    assert f"{len(drawn['marks'])} note" in told


def test_the_values_of_the_trend_stand_in_a_table(shown: Shown) -> None:
    document = page(shown.client.get(HERE))
    assert len(document.cssselect("#trend-chart .chart-values tbody tr")) == len(shown.records)


def test_the_time_shown_lives_in_the_address(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    record(repository, store, ended_ns=time.time_ns() - 100 * NANOSECONDS_PER_DAY)
    recent = page(client.get(HERE))
    assert "There is no valid record in this time" in recent.text_content()
    assert f"{HERE}?days=all" in addresses(recent, "#trend a")
    document = page(client.get(f"{HERE}?days=all"))
    assert words(document, '.spans a[aria-current="true"]') == ["all"]
    assert chart(document)
    refused = client.get(f"{HERE}?days=12")
    assert refused.status_code == 422
    assert "1, 7, 30, 90, 365, all" in refused.text


def test_who_looks_closer_gets_the_records_of_that_time(shown: Shown) -> None:
    client = shown.client
    whole = chart(page(client.get(HERE)))["x"]["values"]
    answer = client.get(f"{HERE}/trend", params={"from_s": whole[10] - 1.0, "to_s": whole[20] - 1.0})
    assert answer.status_code == 200
    piece = answer.json()
    assert piece["x"]["values"] == pytest.approx(whole[10:20])
    assert [one["label"] for one in piece["series"]][:2] == ["95 % interval", "level"]
    assert client.get(f"{HERE}/trend", params={"from_s": 5.0, "to_s": 1.0}).status_code == 422
    assert client.get(f"{HERE}/trend", params={"from_s": "nan", "to_s": 1.0}).status_code == 422
    assert len(shown.records) == len(whole)


def test_pictures_tell_in_words_what_they_show(shown: Shown) -> None:
    asymmetry, load = words(page(shown.client.get(STATOR)), "#pictures svg title")
    assert f"{MOTOR}: asymmetry by phase. Mean of the dots " in asymmetry
    assert "change since then" in asymmetry
    assert f"fault level against load. {len(shown.records)} records between" in load
    (supply,) = words(page(shown.client.get(SUPPLY)), "figure.picture svg title")
    assert "unbalance of currents against voltages. Latest record" in supply
    (profile,) = words(page(shown.client.get(f"{HERE}/load")), "figure.picture svg title")
    assert "load profile. Most, 100 % of the records" in profile


def test_current_voltage_and_power_are_drawn_over_the_time_of_the_trend(shown: Shown) -> None:
    values = {MeteredQuantity.IA: 1.5, MeteredQuantity.VAB: 381.0, MeteredQuantity.POWER: 612.0}
    now_ns = time.time_ns()
    minutes = [now_ns - number * 60 * NANOSECONDS_PER_SECOND for number in range(600)]
    told = {one.value: value for one, value in values.items()}
    shown.repository.add_samples([Sample(MOTOR, at_ns, told) for at_ns in minutes])
    document = page(shown.client.get(HERE))
    trend = chart(document)
    for key, label, value in (("current", "a", 1.5), ("voltage", "ab", 381.0), ("power", "active", 0.612)):
        drawn = json.loads(document.cssselect(f"#{key}-data")[0].text_content())
        (series,) = drawn["series"]
        assert (series["label"], set(series["values"])) == (label, {value})
        assert drawn["sync"] == trend["sync"]
        assert drawn["x"]["to"] == pytest.approx(trend["x"]["to"], abs=1.0)
    assert json.loads(document.cssselect("#voltage-data")[0].text_content())["bands"] == [
        {"low": 342.0, "high": 418.0, "label": "rated ±10 % (NEMA MG-1)", "tone": "muted"}
    ]


def test_measured_values_come_with_their_time(client: httpx.Client, repository: Repository) -> None:
    values = {MeteredQuantity.IA: 12.5, MeteredQuantity.POWER: 6100.0, MeteredQuantity.MAXIMUM_VAB: 421.0}
    at_ns = time.time_ns() - 300 * NANOSECONDS_PER_SECOND
    repository.add_samples([Sample(MOTOR, at_ns, {one.value: value for one, value in values.items()})])
    document = page(client.get(SUPPLY))
    shown = dict(zip(words(document, "#measured dt"), words(document, "#measured dd"), strict=True))
    assert shown == {"Current a": "12.5 A", "Power": "6100 W", "Largest voltage ab": "421 V"}
    assert "5 minutes ago" in words(document, "#measured")[0]


def test_every_measured_quantity_has_words(client: httpx.Client, repository: Repository) -> None:
    values = {one.value: 1.0 for one in MeteredQuantity}
    repository.add_samples([Sample(MOTOR, time.time_ns(), values)])
    names = words(page(client.get(SUPPLY)), "#measured dt")
    assert len(names) == len(set(names)) == len(MeteredQuantity)


def test_nameplate_and_parameters_say_where_they_come_from(
    client: httpx.Client, repository: Repository
) -> None:
    know(repository)
    (text,) = words(page(client.get(NAMEPLATE)), "#nameplate")
    assert "Rated power at the shaft800 W" in text
    assert "Poles4, 1500 rpm without slip" in text
    assert "Stator windingnot given" in text
    assert "Parameters: given in the motors file" in text
    assert "Stator resistance R_s8.4 ohm within 10 %" in text
    assert "Limit of the fault level0.50 %" in text


def test_forms_are_there_for_those_who_may(shown: Shown) -> None:
    client, repository = shown.client, shown.repository
    seen: dict[Role, set[str] | None] = {}
    for role in Role:
        headers = {"Authorization": f"Bearer {token_of(repository, role, name=role.value.lower())}"}
        answers = [client.get(tab, headers=headers) for tab in (HERE, RECORDINGS, LOGBOOK)]
        found = [forms(page(one)) - {"withdrawal"} for one in answers if one.status_code == 200]
        seen[role] = set().union(*found) if found else None
    operator = {"recording-requests", "notes", "planned-stop", "inspections"}
    assert seen == {
        Role.VIEWER: set(),
        Role.OPERATOR: operator,
        Role.ENGINEER: operator | {"diagnoses", "reference", "reports"},
        Role.SECADM: None,
        Role.SECAUD: None,
    }


def test_a_recording_is_asked_for(client: httpx.Client, repository: Repository) -> None:
    answer = client.post(f"{HERE}/recording-requests")
    assert (answer.status_code, answer.headers["location"]) == (303, f"{RECORDINGS}?done=recording-requested")
    (request,) = repository.recording_requests(motor=MOTOR, limit=5).items
    document = page(client.get(answer.headers["location"]))
    assert words(document, "#messages") == [
        "The relay is asked for a recording. It comes within a minute or so."
    ]
    assert request.state in words(document, "#records li")[0]


def test_a_long_recording_is_offered_and_asked_for(client: httpx.Client, repository: Repository) -> None:
    (button,) = page(client.get(HERE)).cssselect("button[name=seconds]")
    assert button.text_content() == "Record 10 s (rotor)"
    client.post(f"{HERE}/recording-requests", data={"seconds": button.get("value") or ""})
    (request,) = repository.recording_requests(motor=MOTOR, limit=5).items
    assert request.seconds == 10.0
    assert client.post(f"{HERE}/recording-requests", data={"seconds": "300"}).status_code == 422


def test_the_latest_record_is_diagnosed_again(shown: Shown) -> None:
    client, repository, records = shown.client, shown.repository, shown.records
    document = page(client.get(RECORDINGS))
    (field,) = document.cssselect('form[action$="/diagnoses"] input')
    assert field.get("value") == records[-1]
    answer = client.post(f"{HERE}/diagnoses", data={"recording": records[-1]})
    assert answer.headers["location"] == f"{RECORDINGS}?done=diagnosis-requested"
    assert len(repository.jobs(records[-1], limit=5).items) == 2


def test_the_motor_is_accepted_as_it_is_with_a_reason(client: httpx.Client, repository: Repository) -> None:
    refused = client.post(f"{HERE}/reference", data={"reason": " "})
    assert refused.status_code == 422
    assert client.post(f"{HERE}/reference", data={"reason": "surge test passed"}).status_code == 303
    (note,) = repository.events(MOTOR, limit=5).items
    assert (note.kind, note.reason, note.by) == (
        EventKind.REFERENCE_RESTARTED,
        "surge test passed",
        "tester",
    )


def test_a_note_is_written_for_a_time_in_utc_and_withdrawn(
    client: httpx.Client, repository: Repository
) -> None:
    yesterday = datetime.now(UTC) - timedelta(days=1)
    data = {"text": "bearing\r\nreplaced", "kind": "maintenance", "time": f"{yesterday:%Y-%m-%dT%H:%M}"}
    for year in ("0001", "1969", "2199"):
        odd = client.post(f"{HERE}/notes", data={"text": "x", "time": f"{year}-01-01T00:00"})
        assert odd.status_code == 422, year
    refused = client.post(f"{HERE}/notes", data=data)
    assert refused.status_code == 422
    assert "has the motor judged anew" in refused.text
    assert client.post(f"{HERE}/notes", data={**data, "anew": "yes"}).status_code == 303
    (note,) = repository.events(MOTOR, limit=5).items
    assert (note.kind, note.reason) == (EventKind.MAINTENANCE, "bearing\nreplaced")
    minute_ns = 60 * NANOSECONDS_PER_SECOND
    assert note.time_ns == int(yesterday.timestamp()) * NANOSECONDS_PER_SECOND // minute_ns * minute_ns

    document = page(client.get(LOGBOOK))
    assert "bearing replaced" in words(document, "#logbook .notes li")[0]
    gone = client.post(f"{HERE}/notes/{note.id}/withdrawal", data={"reason": "another motor"})
    assert gone.headers["location"] == f"{LOGBOOK}?done=note-withdrawn"
    (told,) = words(page(client.get(LOGBOOK)), "#logbook .notes .withdrawn")
    assert "by tester: another motor" in told


def test_an_operator_writes_notes_that_change_nothing_else(
    client: httpx.Client, repository: Repository
) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.OPERATOR, name='olga')}"
    assert not page(client.get(LOGBOOK)).cssselect('form[action$="/notes"] select[name="kind"]')
    assert client.post(f"{HERE}/notes", data={"text": "noisy"}).status_code == 303
    refused = client.post(f"{HERE}/notes", data={"text": "rewound", "kind": "rewound"})
    assert refused.status_code == 403
    assert [note.reason for note in repository.events(MOTOR, limit=5).items] == ["noisy"]


def test_an_alarm_of_the_motor_is_acknowledged_here(client: httpx.Client, repository: Repository) -> None:
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns", "shorted-turns")
    alarm = repository.raise_alarm_at(AlarmPlace(motor=MOTOR), spec, now_ns=time.time_ns())
    document = page(client.get(HERE))
    (action,) = addresses(document, "#alarms form")
    (way_back,) = document.cssselect('#alarms form input[name="next"]')
    answer = client.post(action, data={"next": way_back.get("value"), "comment": "on my way"})
    assert answer.headers["location"] == f"{HERE}?done=acknowledged"
    assert repository.alarm(alarm.id).comment == "on my way"
    assert "acknowledged by tester" in words(page(client.get(HERE)), "#alarms")[0]


def test_hostile_texts_stay_texts(client: httpx.Client, repository: Repository) -> None:
    now_ns = time.time_ns()
    repository.add_event(
        MOTOR, Event(now_ns, EventKind.NOTE, HOSTILE), by=Actor(HOSTILE, "::1"), now_ns=now_ns
    )
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, HOSTILE, "shorted-turns")
    repository.raise_alarm_at(AlarmPlace(motor=MOTOR), spec, now_ns=now_ns)
    for tab in (HERE, LOGBOOK):
        answer = client.get(tab)
        assert HOSTILE not in answer.text
        assert HOSTILE in page(answer).text_content()


def test_starts_and_trips_are_marked_in_the_trend(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    record(repository, store)
    added = RecordedStarts(repository, store)
    at_ns = time.time_ns() - 3 * 3600 * NANOSECONDS_PER_SECOND
    added.add(None, at_ns=at_ns)
    marks = chart(page(client.get(HERE)))["marks"]
    assert marks == [{"x": pytest.approx(at_ns / 1e9, abs=0.01), "label": "start", "tone": "muted"}]


def test_a_trip_of_the_relay_s_sequence_is_marked_and_one_that_is_recorded_is_not_doubled(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    record(repository, store)
    at_ns = time.time_ns() - 3 * 3600 * NANOSECONDS_PER_SECOND
    RecordedStarts(repository, store).add(None, at_ns=at_ns)
    told = [
        RelayEvent(RelayEventKind.START, at_ns + 2 * NANOSECONDS_PER_SECOND),
        RelayEvent(RelayEventKind.TRIP, at_ns + 60 * NANOSECONDS_PER_SECOND),
        RelayEvent(RelayEventKind.STOP, at_ns + 61 * NANOSECONDS_PER_SECOND),
    ]
    repository.add_relay_events(MOTOR, told, by=ADA, now_ns=time.time_ns())
    marks = chart(page(client.get(HERE)))["marks"]
    assert [one["label"] for one in marks] == ["start", "trip", "stop"]


def test_a_kind_that_is_named_is_told_with_its_phase() -> None:
    def told(condition: Judged, **changes: Any) -> str:
        document = replace(condition, **changes).as_dict()
        return finding(Condition.model_validate({**document, "motor": MOTOR}), None, complete=True)

    assert told(FAULT) == "Shorted turns in phase b"
    assert told(HEALTHY) == "No change is seen"
    assert told(DRIFTING) == "A change in phase c that may be an error of a voltage channel or shorted turns"
    assert told(DRIFTING, candidates=()).startswith("The latest record differs from all before")
    assert (
        told(FAULT, state=State.WATCH, change=0.0, phase="a")
        == "Shorted turns in phase a were seen, and are gone"
    )
    assert told(FAULT, state=State.WATCH, kind=Kind.NONE).startswith("Its asymmetry from the first record on")
    assert set(KINDS) == set(Kind) - BESIDE_STATOR - {Kind.NONE, Kind.UNCLEAR}


def test_the_axis_of_the_trend_is_not_pressed_flat_by_a_level_far_above() -> None:
    point = ConditionPoint(
        recording_id="a-record", time_ns=1, state=State.HEALTHY, kind=Kind.NONE, mu_f=0.001
    )
    trend = ThinnedTrend(0, 10, 1, (point,), ())
    near = trend_chart("P", trend, limit=0.005, ahead=0.02, detectable=0.004)
    assert [one.label for one in near.limits] == [
        "motor's limit 0.50 %",
        "next level 2.00 %",
        "detection limit 0.40 %",
    ]
    far = trend_chart("P", trend, limit=0.005, ahead=0.005, detectable=0.1687)
    assert [one.label for one in far.limits] == ["motor's limit 0.50 %"]
    assert "Above what is drawn: detection limit 16.87 %." in far.summary
