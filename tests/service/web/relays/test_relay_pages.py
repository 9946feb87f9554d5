"""The pages of relays: what they show, and the form that ends a quarantine."""

import re
import time
from datetime import timedelta
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext
from service.configuration.relay_access import RelayAccess, RelayTls
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import ClockNote, ClockReading, RelayFindings, Role
from service.storage.states import AlarmKind, ClockQuality, LinkState
from service.timing.backoff import Backoff
from service.web.app import create_site
from testing.relays.certificates import identity
from testing.service.accounts import token_of
from testing.service.links import set_link_state
from tests.service.api.serving import serving
from tests.service.web.pages import HOSTILE, addresses, page, words

A, B = "A1_SEL710", "A2_SEL710"
NOW_NS = time.time_ns()
SECOND = 10**9


@pytest.fixture
def busy(repository: Repository) -> Repository:
    """One relay that has everything to tell, beside one that nobody has visited."""
    set_link_state(repository, A, LinkState.UP, None, now_ns=NOW_NS - 86_400 * SECOND)
    set_link_state(repository, A, LinkState.DOWN, f"refused {HOSTILE}", now_ns=NOW_NS - 60 * SECOND)
    reading = ClockReading(-7 * SECOND, SECOND // 10, ClockQuality.NOT_SYNCHRONISED, NOW_NS)
    repository.note_clocks([ClockNote(A, reading)])
    difference = {"kind": "logical-node", "expected": HOSTILE, "found": None}
    ignored = {"name": f"{HOSTILE}.TXT", "reason": "no file of a recording"}
    acquisition = {
        "asked": True,
        "trigger": HOSTILE,
        "records_told_by": "polling",
        "overridden": ["report_control"],
        "remarks": [HOSTILE],
    }
    repository.note_findings(RelayFindings(A, NOW_NS, acquisition, [difference], [ignored], 120))
    repository.raise_alarm(A, AlarmKind.FILE_REFUSED, HOSTILE, "outside", now_ns=NOW_NS)
    return repository


def test_relays_are_listed_with_link_clock_records_and_what_differs(
    client: httpx.Client, busy: Repository
) -> None:
    del busy
    document = page(client.get("/relays"))
    assert words(document, "section[aria-labelledby=gateways] p") == [
        "No gateway runs: no relay is visited at present."
    ]
    assert words(document, ".counts a") == ["1 down", "1 unknown"]
    first, second = (words(row, "td") for row in document.cssselect("tbody tr"))
    assert first[0].startswith(f"downrefused {HOSTILE}since ")
    assert first[1:3] == ["24 hours ago", "never"]
    assert first[3] == "7 s behind (± 0.1 s), says it is not synchronised"
    assert first[4:] == ["1 difference", "120", "none needed", "1"]
    assert second[0] == "unknown"
    assert second[1:] == [
        "never",
        "never",
        "not compared yet",
        *["not visited yet"] * 2,
        "none needed",
        "none",
    ]
    assert addresses(document, "tbody th a") == [
        f"/relays/{A}",
        "/motors/PUMP-A1",
        f"/relays/{B}",
        "/motors/FAN-A2",
    ]


def test_relays_are_chosen_by_the_address(client: httpx.Client, busy: Repository) -> None:
    del busy

    def names(query: str) -> list[str]:
        return words(page(client.get(f"/relays?{query}")), "tbody th > a")

    assert names("link=down") == [A]
    assert names("site=FACTORY_A&text=fan&link=") == [B]
    assert "No relay is like that" in client.get("/relays?link=quarantined").text
    assert client.get("/relays?link=broken").status_code == 422


def test_one_relay_tells_all_that_is_known_of_it(client: httpx.Client, busy: Repository) -> None:
    del busy
    document = page(client.get(f"/relays/{A}"))
    (caption,) = words(document, "figcaption")
    told = (
        r"The relay answered \d+\.\d % of the 24 hours that are known of the last 30 days, with one outage\."
    )
    assert re.fullmatch(told, caption)
    assert document.cssselect("figure svg title")[0].text_content().startswith(f"Link of {A}.")
    text = " ".join(document.text_content().split())
    assert "An alarm tells when it is more than 5 s off." in text
    assert "The first 1 of 120." in text
    assert "The motors file decides: report_control" in text
    cells = words(document, "section[aria-labelledby=differences] td")
    assert cells == ["logical node", HOSTILE, "nothing"]
    assert words(document, "section[aria-labelledby=files] td") == [
        f"{HOSTILE}.TXT",
        "no file of a recording",
    ]
    assert words(document, "section[aria-labelledby=changes] td")[1] == "down"
    assert client.get("/relays/NOPE").status_code == 404
    empty = " ".join(page(client.get(f"/relays/{B}?days=7")).text_content().split())
    assert "No data of the link in the last 7 days." in empty
    assert "Nobody has visited it yet." in empty


def test_a_relay_set_aside_is_released_by_who_may(client: httpx.Client, repository: Repository) -> None:
    repository.set_aside(A, "crashed a gateway", backoff=Backoff(600.0, 600.0), now_ns=NOW_NS)
    here = f"/relays/{A}"
    document = page(client.get(here))
    assert "(1 time in a row): crashed a gateway" in " ".join(document.text_content().split())
    assert addresses(document, f"form[action='{here}/release']") == [f"{here}/release"]
    everything = client.headers["Authorization"]
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.VIEWER, name='viewer')}"
    assert not page(client.get(here)).cssselect("form[action$=release]")
    assert client.post(f"{here}/release").status_code == 403
    client.headers["Authorization"] = everything
    answer = client.post(f"{here}/release")
    assert answer.headers["location"] == f"{here}?done=released"
    assert repository.quarantine(A) is None
    document = page(client.get(answer.headers["location"]))
    assert words(document, "#messages") == ["The relay is released, and visited again within seconds."]
    assert not document.cssselect("form[action$=release]")


def test_certificates_that_end_are_told(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    own, peer = (
        identity(tmp_path, name, until=timedelta(days=days)) for name, days in (("own", 10), ("peer", 400))
    )
    gone = tmp_path / "gone.pem"
    tls = RelayTls(certificate=own.certificate_file, key=own.key_file, pinned=(peer.certificate_file,))
    broken = RelayTls(certificate=gone, key=own.key_file, pinned=(peer.certificate_file,))
    settings = Settings(data_directory=tmp_path, relays={A: RelayAccess(tls=tls), B: RelayAccess(tls=broken)})
    with serving(create_site(ApiContext(settings, repository, store))) as client:
        client.headers["Accept"] = "text/html"
        document = page(client.get("/relays"))
        cells = words(document, "td[data-label=Certificates]")
        assert cells == ["ends in 9 days", "cannot be read"]
        text = page(client.get(f"/relays/{A}")).text_content()
        assert str(own.certificate_file) in text
        plant = page(client.get("/plant"))
        rows = words(plant, "section[aria-labelledby=certificates] tbody tr")
        assert [row.partition(".pem")[0].rpartition("/")[2] for row in rows] == ["gone", "own", "peer"]
        assert rows[2].endswith(f"relay {A}, relay {B}")
        assert str(peer.certificate_file) in text


@pytest.mark.parametrize("state", [LinkState.DOWN, LinkState.QUARANTINED])
def test_a_link_state_has_one_word_on_every_page(
    client: httpx.Client, repository: Repository, state: LinkState
) -> None:
    set_link_state(repository, A, state, "refused", now_ns=NOW_NS)
    word = str(state)
    assert words(page(client.get(f"/relays/{A}")), "#relay .state")[0] == word
    assert word in words(page(client.get("/relays")), "tbody td")[0]
    assert f"(link {word})" in page(client.get("/motors/PUMP-A1")).text_content()
    assert f"link {word}: {A}" in page(client.get("/")).text_content()
