"""The pages of alarms: what they show, and what their forms do."""

import time
from uuid import uuid4

import httpx
import pytest

from service.storage import Repository
from service.storage.records import Actor, Alarm, Role
from service.storage.records.alarms import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, AlarmState
from testing.service.accounts import token_of
from tests.service.web.pages import HOSTILE, addresses, page, words

NOW_NS = time.time_ns()
ADA = Actor("ada", "::1")


def raised(repository: Repository, motor: str, *, at_ns: int = NOW_NS, value: float | None = None) -> Alarm:
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, f"shorted turns {HOSTILE}", "shorted-turns", value=value)
    return repository.raise_alarm_at(AlarmPlace(motor=motor), spec, now_ns=at_ns)


@pytest.fixture
def pump(repository: Repository) -> Alarm:
    return raised(repository, "PUMP-A1", value=0.05)


@pytest.fixture
def fan(repository: Repository) -> Alarm:
    return raised(repository, "FAN-A2", at_ns=NOW_NS - 10)


def test_active_alarms_say_what_where_since_when_and_what_to_do(
    client: httpx.Client, pump: Alarm, fan: Alarm
) -> None:
    document = page(client.get("/alarms"))
    assert words(document, ".alarm h2") == ["PUMP-A1: condition fault", "FAN-A2: condition fault"]
    assert words(document, ".alarm .state") == ["critical, unacknowledged"] * 2
    (first, _) = words(document, ".alarm .what")
    assert "What to do: Do what the advice of the motor's condition says" in first
    assert words(document, ".tabs a") == ["Active (2)", "Shelved and set aside (0)", "History"]
    links = addresses(document, ".alarm h2 a")
    assert links == ["/motors/PUMP-A1", f"/alarms/{pump.id}", "/motors/FAN-A2", f"/alarms/{fan.id}"]


def test_without_alarms_the_page_says_so(client: httpx.Client) -> None:
    assert "No alarm is active" in client.get("/alarms").text
    assert "No alarm is shelved" in client.get("/alarms?show=set-aside").text
    assert "There was no alarm yet" in client.get("/alarms?show=history").text


def test_filters_live_in_the_address(client: httpx.Client, pump: Alarm, fan: Alarm) -> None:
    del pump, fan
    document = page(client.get("/alarms", params={"text": "pump", "site": "FACTORY_A"}))
    assert words(document, ".alarm h2") == ["PUMP-A1: condition fault"]
    assert addresses(document, ".tabs a")[2] == ("/alarms?show=history&site=FACTORY_A&text=pump")
    assert "No alarm is like that" in client.get("/alarms", params={"text": HOSTILE}).text
    for show in ("active", "history"):
        document = page(client.get("/alarms", params={"motor": "FAN-A2", "show": show}))
        assert words(document, ".alarm h2") == ["FAN-A2: condition fault"]
        assert "Only of motor FAN-A2" in words(document, "main form[role=search]")[0]
        assert addresses(document, ".tabs a")[1] == "/alarms?show=set-aside&motor=FAN-A2"
    assert "No alarm is like that" in client.get("/alarms", params={"relay": HOSTILE}).text


def test_several_are_acknowledged_at_once_with_a_comment(
    client: httpx.Client, repository: Repository, pump: Alarm, fan: Alarm
) -> None:
    answer = client.post(
        "/alarms/acknowledgements",
        data={"alarm": [pump.id, fan.id], "comment": "seen\r\nboth", "next": "/alarms?site=FACTORY_A"},
    )
    assert (answer.status_code, answer.headers["location"]) == (
        303,
        "/alarms?site=FACTORY_A&done=acknowledged",
    )
    for one in (pump, fan):
        alarm = repository.alarm(one.id)
        assert (alarm.state, alarm.changed_by) == (AlarmState.ACKNOWLEDGED, "tester")
        assert alarm.comment == "seen\nboth"
    document = page(client.get(answer.headers["location"]))
    assert words(document, "#messages") == ["Acknowledged."]
    assert "acknowledged by tester" in words(document, ".alarm")[0]


def test_the_button_of_one_alarm_acknowledges_it_alone(
    client: httpx.Client, repository: Repository, pump: Alarm, fan: Alarm
) -> None:
    client.post("/alarms/acknowledgements", data={"alarm": [pump.id], "only": fan.id})
    assert repository.alarm(pump.id).state is AlarmState.UNACKNOWLEDGED
    assert repository.alarm(fan.id).state is AlarmState.ACKNOWLEDGED


def test_who_comes_second_is_told_who_was_first(
    client: httpx.Client, repository: Repository, pump: Alarm, fan: Alarm
) -> None:
    repository.acknowledge_alarm(pump.id, by=ADA, now_ns=NOW_NS, comment="mine")
    answer = client.post("/alarms/acknowledgements", data={"alarm": [pump.id, fan.id]})
    document = page(client.get(answer.headers["location"]))
    (told,) = words(document, "section.card li")
    assert told.startswith("PUMP-A1: condition fault is acknowledged: acknowledged by ada")
    assert told.endswith("mine")
    alone = client.post(f"/alarms/{pump.id}/acknowledgement", data={})
    assert alone.headers["location"] == f"/alarms/{pump.id}?done=not-acknowledged"
    of_list = client.post("/alarms/acknowledgements", data={"only": pump.id, "comment": "x"})
    assert of_list.headers["location"] == alone.headers["location"]
    led = page(client.get(alone.headers["location"]))
    assert words(led, "#messages")[0].startswith("Not acknowledged")
    assert "acknowledged by ada" in words(led, "#alarm")[0]
    both = client.post("/alarms/acknowledgements", data={"alarm": [pump.id, fan.id]})
    assert len(words(page(client.get(both.headers["location"])), "section.card li")) == 2


def test_nothing_chosen_is_told_in_words(client: httpx.Client, pump: Alarm) -> None:
    del pump
    answer = client.post("/alarms/acknowledgements", data={"comment": "x"})
    assert answer.status_code == 422
    assert "alarms" in answer.text
    too_long = client.post("/alarms/acknowledgements", data={"alarm": [str(uuid4())], "comment": "x" * 501})
    assert too_long.status_code == 422


def test_a_way_back_to_another_site_is_not_taken(client: httpx.Client, pump: Alarm) -> None:
    answer = client.post("/alarms/acknowledgements", data={"only": pump.id, "next": "//evil.example/alarms"})
    assert answer.headers["location"] == "/alarms?done=acknowledged"


def test_an_alarm_is_shelved_until_a_time_or_growth_and_back(
    client: httpx.Client, repository: Repository, pump: Alarm
) -> None:
    here = f"/alarms/{pump.id}"
    neither = client.post(f"{here}/shelving", data={"hours": "", "growth_percent": ""})
    assert neither.status_code == 422
    assert "a shelving always has an end" in neither.text
    assert client.post(f"{here}/shelving", data={"growth_percent": "much"}).status_code == 422
    assert client.post(f"{here}/shelving", data={"hours": "999999"}).status_code == 422
    answer = client.post(
        f"{here}/shelving", data={"hours": "24", "growth_percent": "0,5", "comment": "Friday"}
    )
    assert answer.headers["location"] == f"{here}?done=shelved"
    alarm = repository.alarm(pump.id)
    assert alarm.state is AlarmState.SHELVED
    assert alarm.shelved_above == pytest.approx(0.055)
    document = page(client.get("/alarms?show=set-aside"))
    (made,) = words(document, ".alarm .what p.muted")
    assert made.startswith("shelved until 20")
    assert "or until its level is above 5.50 % by tester: " in made
    client.post(f"{here}/unshelving", data={})
    assert repository.alarm(pump.id).state is AlarmState.UNACKNOWLEDGED
    client.post(f"{here}/out-of-service", data={"comment": "relay is replaced"})
    assert repository.alarm(pump.id).state is AlarmState.OUT_OF_SERVICE
    client.post(f"{here}/back-in-service", data={})
    assert repository.alarm(pump.id).state is AlarmState.UNACKNOWLEDGED


def test_one_alarm_with_its_history_and_what_was_sent(
    client: httpx.Client, repository: Repository, pump: Alarm
) -> None:
    repository.acknowledge_alarm(pump.id, by=ADA, now_ns=NOW_NS + 1, comment=HOSTILE)
    document = page(client.get(f"/alarms/{pump.id}"))
    assert words(document, "h1") == ["PUMP-A1: condition fault"]
    cells = words(document, "#alarm-history td")
    assert cells[1:5] == ["acknowledged", "acknowledged", "ada", HOSTILE]
    assert cells[6:9] == ["raised", "unacknowledged", "statorwatch"]
    assert "No message told of it." in document.text_content()
    actions = addresses(document, "section button")
    assert actions == [f"/alarms/{pump.id}/out-of-service", f"/alarms/{pump.id}/shelving"]
    assert client.get(f"/alarms/{uuid4()}").status_code == 404


def test_a_flood_is_one_line_with_its_members(client: httpx.Client, repository: Repository) -> None:
    spec = AlarmSpec(AlarmKind.ALARM_FLOOD, "12 alarms", "low")
    flood = repository.raise_alarm_at(AlarmPlace(), spec, now_ns=NOW_NS)
    document = page(client.get(f"/alarms/{flood.id}"))
    assert words(document, "h1") == ["The service: alarm flood"]
    assert words(page(client.get("/alarms")), ".alarm h2") == ["the service: alarm flood"]


def test_long_lists_come_in_pages(client: httpx.Client, repository: Repository) -> None:
    for number in range(52):
        spec = AlarmSpec(AlarmKind.FILE_REFUSED, "outside", f"file {number}")
        repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=NOW_NS + number)
    first = page(client.get("/alarms"))
    (further,) = addresses(first, "a[rel=next]")
    second = page(client.get(further))
    assert (len(first.cssselect(".alarm")), len(second.cssselect(".alarm"))) == (50, 2)
    assert client.get("/alarms?cursor=nonsense").status_code == 422


def test_who_may_not_acknowledge_sees_no_button_and_is_refused(
    client: httpx.Client, repository: Repository, pump: Alarm
) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.VIEWER, name='viewer')}"
    for path in ("/alarms", f"/alarms/{pump.id}"):
        document = page(client.get(path))
        assert document.cssselect("main button") == document.cssselect("form[role=search] button")
        assert not document.cssselect("input[type=checkbox], textarea")
        assert "What was sent to whom" not in document.text_content()
    refused = client.post("/alarms/acknowledgements", data={"only": pump.id})
    assert refused.status_code == 403
    assert repository.alarm(pump.id).state is AlarmState.UNACKNOWLEDGED


def test_an_operator_acknowledges_and_shelves_but_takes_nothing_out_of_service(
    client: httpx.Client, repository: Repository, pump: Alarm
) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.OPERATOR, name='operator')}"
    document = page(client.get(f"/alarms/{pump.id}"))
    actions = [path.rpartition("/")[2] for path in addresses(document, "section button")]
    assert actions == ["acknowledgement", "shelving"]
    assert client.post(f"/alarms/{pump.id}/out-of-service", data={}).status_code == 403
    assert client.post(f"/alarms/{pump.id}/acknowledgement", data={}).status_code == 303


def test_a_comment_has_its_author_whatever_the_state_of_the_alarm(
    client: httpx.Client, repository: Repository, pump: Alarm
) -> None:
    place = AlarmPlace(motor="PUMP-A1")
    repository.clear_alarms_at(place, AlarmKind.CONDITION_FAULT, now_ns=NOW_NS, why="it is gone")
    for path in ("/alarms", f"/alarms/{pump.id}"):
        assert "statorwatch: it is gone" in " ".join(page(client.get(path)).text_content().split())


def test_who_acknowledged_all_by_mistake_undoes_it_by_a_click(
    client: httpx.Client, repository: Repository
) -> None:
    now_ns = time.time_ns()
    ids = [
        repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, name, "outside", now_ns=now_ns).id
        for name in ("X.CFG", "Y.CFG")
    ]
    assert not page(client.get("/alarms")).cssselect("#undo")
    client.post("/alarms/acknowledgements", data={"alarm": ids})
    document = page(client.get("/alarms"))
    assert "Acknowledged by you in the last ten minutes: 2 alarms" in words(document, "#undo")[0]
    (undo,) = addresses(document, "#undo")
    fields = [one.get("value") for one in document.cssselect("#undo input[name=alarm]")]
    answer = client.post(undo, data={"alarm": fields})
    assert answer.headers["location"] == "/alarms?done=acknowledgement-undone"
    assert {repository.alarm(one).state for one in ids} == {AlarmState.UNACKNOWLEDGED}
    assert not page(client.get("/alarms")).cssselect("#undo")
