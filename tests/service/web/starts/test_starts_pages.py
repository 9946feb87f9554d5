"""The pages of starts: the latest over the reference, their figures, and what cannot be told."""

from dataclasses import replace

import httpx
import pytest

from core.condition.events import Event, EventKind
from core.starts.examined import ExaminedStart, StartStress
from core.starts.examining import examine_start
from core.starts.figures import MotorStart
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, ReportedStart
from testing.machines.motors import MEDIUM
from testing.machines.starts import StartRecord
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.starts import START, RecordedStarts
from tests.service.web.pages import addresses, page, words

HERE = "/motors/PUMP-A1/starts"
ADA = Actor("ada", "::1")


def slower(share: float) -> MotorStart:
    assert START.acceleration_s is not None
    return replace(START, acceleration_s=START.acceleration_s * share, i2t_A2s=START.i2t_A2s * share)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> RecordedStarts:
    return RecordedStarts(repository, store)


def test_starts_are_shown_beside_the_first_whole_one(client: httpx.Client, recorded: RecordedStarts) -> None:
    part = replace(START, is_from_rest=False, acceleration_s=None)
    ids = [recorded.add(one) for one in (part, START, slower(1.2), replace(START, lowest_voltage_V=None))]

    document = page(client.get(HERE))

    rows = words(document, "tbody tr")
    assert len(rows) == 4
    assert rows[2].endswith("reference")
    assert "+20 % time, +20 % I²t" in rows[1]
    assert "1.5 s" in rows[1]
    assert "94.6 A 11 ×" in rows[2]
    assert "16.3 A" in rows[2]
    assert "372 V 93 %" in rows[2]
    assert "334 A²s" in rows[2]
    assert "began before the record" in rows[3]
    assert "time" not in rows[3].rpartition("A²s")[2]
    assert addresses(document, "tbody tr td:first-child a") == [f"/recordings/{one}" for one in ids[::-1]]
    titles = words(document, "figure svg title")
    assert [title.partition(".")[0] for title in titles] == [
        "PUMP-A1: current of recorded starts",
        "PUMP-A1: voltage of recorded starts",
    ]
    assert "2 starts; the latest reaches" in titles[0]


def test_a_rewound_motor_has_another_reference(
    client: httpx.Client, repository: Repository, recorded: RecordedStarts
) -> None:
    recorded.add(START)
    event = Event(NOW_NS + 3 * SECOND_NS // 2, EventKind.REWOUND, "new winding")
    repository.add_event("PUMP-A1", event, by=ADA, now_ns=NOW_NS)
    recorded.add(replace(START, acceleration_s=None))
    without = page(client.get(HERE))
    assert "There is no reference yet: no start since" in without.text_content()
    recorded.add(slower(2.0))
    rows = words(page(client.get(HERE)), "tbody tr")
    assert rows[0].endswith("reference")
    assert "-50 % time" in rows[2]


def test_the_page_says_why_the_latest_starts_are_others(
    client: httpx.Client, recorded: RecordedStarts
) -> None:
    stress = StartStress(10_000.0, None, 0.03, None, "motor file", 6)
    for _ in range(5):
        recorded.add(ExaminedStart(START, stress=stress))
    assert not page(client.get(HERE)).cssselect("#starts p.message")
    weak = replace(START.curve, voltage_V=tuple(0.88 * one for one in START.curve.voltage_V or ()))
    for _ in range(2):
        recorded.add(ExaminedStart(replace(START, acceleration_s=1.7, curve=weak), stress=stress))

    document = page(client.get(HERE))

    (told,) = words(document, "#starts p.message")
    assert told.startswith("The latest starts are other than the first ones: the supply.")
    assert "the voltage of the run-up is -12 %" in told
    rows = words(document, "tbody tr")
    assert "3 %" in rows[0]
    assert "7 more than the 6 allowed" in rows[0]
    assert "6 more" not in rows[1]
    assert "the run-up takes 1.7 s" in rows[0]


def test_the_torque_of_a_start_is_drawn(client: httpx.Client, recorded: RecordedStarts) -> None:
    recorded.add(examine_start(StartRecord(snr_db=45.0).of(MEDIUM), MEDIUM))

    document = page(client.get(HERE))

    titles = [title.partition(".")[0] for title in words(document, "figure svg title")]
    assert titles[-1] == "PUMP-A1: torque of recorded starts"
    assert "N m" in words(document, "tbody tr")[0]


def test_many_starts_come_in_pages(client: httpx.Client, recorded: RecordedStarts) -> None:
    for _ in range(53):
        recorded.add(START)
    here, rows = HERE, []
    while here:
        document = page(client.get(here))
        rows.append(len(document.cssselect("tbody tr")))
        here = next(iter(addresses(document, 'a[rel="next"]')), "")
    assert rows == [8] * 6 + [5]
    (further_of_all,) = addresses(page(client.get("/starts")), 'a[rel="next"]')
    assert len(page(client.get(further_of_all)).cssselect("tbody tr")) == 3
    assert client.get(f"{HERE}?cursor=nonsense").status_code == 422


def test_the_starts_of_one_motor_have_a_page_of_their_own(client: httpx.Client) -> None:
    assert client.get("/starts", params={"motor": "nope"}).status_code == 404
    led = client.get("/starts", params={"motor": "PUMP-A1"}, follow_redirects=False)
    assert led.headers["location"] == "/motors/PUMP-A1/starts"


def test_all_motors_starts_are_listed_the_latest_first(
    client: httpx.Client, recorded: RecordedStarts
) -> None:
    recorded.add(START)
    recorded.add(START, motor="FAN-A2")
    document = page(client.get("/starts"))
    assert addresses(document, "tbody th a") == ["/motors/FAN-A2/starts", HERE]


def test_without_starts_the_pages_say_so(client: httpx.Client) -> None:
    assert "No start is known yet" in client.get("/starts").text
    assert "No start of this motor is known yet" in client.get(HERE).text
    assert client.get("/motors/NO-SUCH/starts").status_code == 404


def test_pages_show_what_tells_of_a_start(
    client: httpx.Client, recorded: RecordedStarts, repository: Repository
) -> None:
    whole = ExaminedStart(START)
    recording_id = recorded.add(replace(START, acceleration_s=None), at_ns=NOW_NS)
    reports = [ReportedStart(at_ns, whole) for at_ns in (NOW_NS + SECOND_NS, NOW_NS + 60 * SECOND_NS)]
    repository.add_reported_starts("PUMP-A1", reports, by=ADA, now_ns=NOW_NS)

    for here in (HERE, "/starts"):
        document = page(client.get(here))
        alone, joined = words(document, "tbody tr")
        assert "UTCreport 1.25 s" in alone.replace("UTC ", "UTC")
        assert "recording, with report" in joined
        assert "1.25 s" in joined
        linked = addresses(document, "tbody tr a")
        assert [one for one in linked if "recordings" in one] == [f"/recordings/{recording_id}"]
