"""What many open pages add to the work of the service: each is told of changes, and fetches what differs."""

import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field

import httpx

from benchmarks.storage.plant import relay_name
from benchmarks.web.answers import HEADERS, Site
from service.api.access.cookies import NAME
from service.storage import Repository
from service.storage.states import AlarmKind

CHANGE_EVERY_S = 5.0
"""The plant changes so often while it is measured: an alarm comes, as from 500 motors on a bad day."""


@dataclass
class Viewer:
    """Follows the fleet's events as an open page does, and fetches the fleet again at each."""

    site: Site
    told_s: list[float] = field(default_factory=list)
    fetched_bytes: int = 0
    _ends: threading.Event = field(default_factory=threading.Event)

    def look(self) -> None:
        """Open the page and follow what changes, until `leave`; a service that ends meanwhile ends it too."""
        with suppress(httpx.HTTPError):
            self._follow()

    def _follow(self) -> None:
        cookies = {NAME: self.site.session}
        with (
            httpx.Client(base_url=self.site.url, headers=HEADERS, cookies=cookies, trust_env=False) as pages,
            httpx.Client(base_url=self.site.url, cookies=cookies, trust_env=False, timeout=30.0) as events,
        ):
            pages.get("/")
            with events.stream("GET", "/live", params={"topic": "fleet"}) as stream:
                for line in stream.iter_lines():
                    if self._ends.is_set():
                        return
                    if line.startswith("event: fleet"):
                        self.told_s.append(time.monotonic())
                        answer = pages.get("/", headers={"HX-Request": "true"})
                        self.fetched_bytes += int(answer.headers.get("content-length", 0))

    def leave(self) -> None:
        """Go at the next line of the stream."""
        self._ends.set()


@contextmanager
def looking(site: Site, number: int) -> Iterator[list[Viewer]]:
    """So many viewers, while the block runs."""
    viewers = [Viewer(site) for _ in range(number)]
    threads = [threading.Thread(target=one.look, daemon=True) for one in viewers]
    with ExitStack() as leaving:
        for thread, viewer in zip(threads, viewers, strict=True):
            thread.start()
            leaving.callback(viewer.leave)
        yield viewers


@dataclass(frozen=True, slots=True)
class Load:
    """Share of a core that the service used, and after how long the viewers were told of a change [s]."""

    cores: float
    longest_told_s: float


def raise_one_more(repository: Repository) -> None:
    """Change the plant: another alarm comes."""
    subject = f"HR_{time.time_ns()}.CFG"
    repository.raise_alarm(relay_name(7), AlarmKind.FILE_REFUSED, subject, "too short", now_ns=time.time_ns())


def load(site: Site, repository: Repository, viewers: int, *, seconds: float) -> Load:
    """Measure the service for a while in which the plant changes every few seconds."""
    with looking(site, viewers) as there:
        time.sleep(3.0)  # until all have opened their page
        begun_s, used_s = time.monotonic(), site.processor_s()
        changed_s: list[float] = []
        while time.monotonic() - begun_s < seconds:
            changed_s.append(time.monotonic())
            raise_one_more(repository)
            time.sleep(CHANGE_EVERY_S)
        spent_s = time.monotonic() - begun_s
        cores = (site.processor_s() - used_s) / spent_s
        told = [
            min((heard - change for heard in one.told_s if heard >= change), default=float("inf"))
            for one in there
            for change in changed_s
        ]
    return Load(cores, max(told, default=0.0))
