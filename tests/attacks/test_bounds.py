"""One takes more than a share: of time with a file, of places with open pages."""

import time
from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest

import scl
from scl import SclError
from service.api import ApiContext
from service.api.access.cookies import NAME
from service.api.server import connection_limits
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import Role
from service.web.app import create_site
from testing.service.listening import listening
from testing.web.followers import until_followed
from testing.web.site import log_in
from tests.scl.documents import scl_text, write_scl

MOST_S = 10.0
"""Of this process's time: the file once took more than a minute, and takes less than a second."""


def test_an_scl_file_of_many_attributes_takes_the_time(tmp_path: Path) -> None:
    many = " ".join(f'a{n}=""' for n in range(300_000))
    path = write_scl(tmp_path / "wide.scd", scl_text(header=f'<Header id="x" {many}/>'))
    assert path.stat().st_size > 3_000_000
    begun_s = time.process_time()
    with pytest.raises(SclError, match="expected at most 200 attributes of an element, found 300001"):
        scl.read(path)
    assert time.process_time() - begun_s < MOST_S


def test_an_scl_file_of_many_namespaces_takes_the_time(tmp_path: Path) -> None:
    many = " ".join(f'xmlns:a{n}="urn:{n}"' for n in range(100_000))
    path = write_scl(tmp_path / "spaces.scd", scl_text(header=f'<Header id="x" {many}/>'))
    begun_s = time.process_time()
    scl.read(path)
    assert time.process_time() - begun_s < MOST_S


def test_a_viewer_takes_all_places_for_live_updates(repository: Repository, tmp_path: Path) -> None:
    settings = Settings(data_directory=tmp_path, max_connections=24)
    places, of_one = 12, 3
    site = create_site(ApiContext(settings, repository, FolderStore(tmp_path / "recordings")))
    greedy = {NAME: log_in(repository, Role.VIEWER)}
    other = {NAME: log_in(repository, Role.OPERATOR)}
    with listening(site, connection_limits(settings)) as port, ExitStack() as opened:

        def open_stream(cookies: dict[str, str]) -> httpx.Response:
            client = opened.enter_context(
                httpx.Client(base_url=f"http://127.0.0.1:{port}", cookies=cookies, trust_env=False)
            )
            answer = client.stream("GET", "/live", params={"topic": "fleet"})
            return opened.enter_context(answer)

        for number in range(of_one):
            assert open_stream(greedy).status_code == 200
            until_followed(site, number + 1)
        refused = [open_stream(greedy) for _ in range(places)]
        assert {answer.status_code for answer in refused} == {503}
        assert "3 streams of open pages of viewer are under way" in refused[0].read().decode()
        assert open_stream(other).status_code == 200
