"""What the routes stand on."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Protocol
from urllib.parse import quote

from fastapi import Depends, Request

from core.machines.parameters import Motor
from service.access.reach import Sites
from service.access.refusals import Refusals
from service.api.limits.admission import Admission
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage.repository import Repository
from service.waveforms.computing import Compute, compute_here
from service.waveforms.recorded import Recorded

Problem = Callable[[], str | None]
"""A check that returns what keeps a part of the service from working; None when it works."""


READING = ("GET", "HEAD")
SITES_KEY = "statorwatch.sites"
"""Where a request has the sites that its caller may see; without it, all."""


class Integration(Protocol):
    """A gateway to another system of the plant.

    restarts: how often it ended since the service started. problem: what does not work; None while all does.
    """

    @property
    def kind(self) -> str: ...

    @property
    def process_id(self) -> int | None: ...

    @property
    def restarts(self) -> int: ...

    @property
    def problem(self) -> str | None: ...


def _nothing() -> None:
    """Do nothing, for an API without a job runner of its own."""


@dataclass(frozen=True, slots=True)
class ApiContext:
    """readiness: a check for each part besides the database. on_new_job: tells the runner not to wait.

    uploads: those stored at a time, after they have arrived. passwords: looked at, each in 64 MiB.
    motors: of the plant's files, by name. time_zones: of relays' clocks that do not run in UTC, by motor.
    compute: has somebody do what needs the numbers. integrations: the gateways to other systems.
    refusals: what was refused since the start.
    waveforms_read: one at a time, because each may have much to read. waveforms_sent: to slow clients, too.
    exports: files of lists, which are made while they are sent. reports: each in a process of its own.
    """

    settings: Settings
    repository: Repository
    store: RecordingStore
    readiness: Mapping[str, Problem] = field(default_factory=dict)
    on_new_job: Callable[[], None] = _nothing
    motors: Mapping[str, Motor] = field(default_factory=dict)
    time_zones: Mapping[str, str] = field(default_factory=dict)
    compute: Compute = compute_here
    integrations: Callable[[], Sequence[Integration]] = tuple
    refusals: Refusals = field(default_factory=Refusals)
    uploads: Admission = field(default_factory=lambda: Admission("uploads", 3, wait_s=10.0))
    passwords: Admission = field(default_factory=lambda: Admission("passwords", 2, wait_s=10.0))
    waveforms_read: Admission = field(default_factory=lambda: Admission("waveforms", 1, wait_s=10.0))
    waveforms_sent: Admission = field(default_factory=lambda: Admission("waveforms", 16, wait_s=10.0))
    exports: Admission = field(default_factory=lambda: Admission("exports", 4, wait_s=10.0))

    reports: Admission = field(default_factory=lambda: Admission("reports", 1, wait_s=20.0))
    audit_trails: Admission = field(default_factory=lambda: Admission("audit trails", 4, wait_s=10.0))
    audit_verifications: Admission = field(
        default_factory=lambda: Admission("verifications of the audit trail", 1, wait_s=10.0)
    )

    @property
    def recorded(self) -> Recorded:
        """Return the stored recordings, to be looked at."""
        return Recorded(self.repository, self.store, self.motors, self.compute)

    def within(self, sites: Sites) -> "ApiContext":
        """Return the same for who may see these sites alone."""
        return self if sites is None else replace(self, repository=self.repository.within(sites))

    def require_motor(self, name: str | None) -> None:
        """Raise NotFoundError where a list is asked for of a motor that there is not; None asks for all."""
        if name is not None:
            self.repository.motor(name)


async def _context_of(request: Request) -> ApiContext:  # async: a plain function would take a thread
    context = request.app.state.context
    if not isinstance(context, ApiContext):
        raise TypeError("the application was not made by create_app")
    # Who changes something was asked where it is; then all rows count, or files that others need would go.
    return context.within(request.scope.get(SITES_KEY)) if request.method in READING else context


def path_to(request: Request, route: str, **parameters: object) -> str:
    """Return the path of a route, for a header: names in it may have any characters."""
    quoted = {name: _segment(str(value)) for name, value in parameters.items()}
    return request.url_for(route, **quoted).path


def _segment(name: str) -> str:
    """Return a name as a segment of a path; dots alone would lead elsewhere."""
    return quote(name, safe="") if name.strip(".") else name.replace(".", "%2E")


Context = Annotated[ApiContext, Depends(_context_of)]
