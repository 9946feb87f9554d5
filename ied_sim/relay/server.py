"""The MMS side of a simulated relay: its model served, its values with quality and time, its files."""

import sys
import threading
from collections.abc import Callable, Mapping
from pathlib import Path

from ied_sim.front.reserved_address import ReservedAddress
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.profiles.profile import Profile
from ied_sim.relay.clock import RelayClock
from ied_sim.relay.configuration import Access
from ied_sim.relay.goose import GooseOutlet, RelayGoose
from ied_sim.relay.points import RelayPoints
from ied_sim.relay.report_control import with_optional_fields, without_data_set
from mms import (
    GOOD,
    MOST_CONNECTIONS,
    AddCause,
    ControlAction,
    DataAccessError,
    FileAnswer,
    FileOperation,
    FileRequest,
    Identity,
    Quality,
    Server,
    Timestamp,
    Value,
)
from scl import Address
from scl.ied_model import Ied

_ANY_NAME = "RELAY"

Operated = Callable[[ControlAction], "bool | AddCause"]
TextSource = Callable[[], bytes]


class RelayServer:
    """Serves the model text of the IED `name` at one address.

    It keeps the values. So it can begin anew as after a restart, and a second server of the library, the
    overflow server, can offer the same values to clients beyond the library's limit. The overflow server has
    report blocks of its own: one that is taken in the server is free there.

    Clients see the folder `root`. Files are made in `staging` before they appear in it. `texts` are files
    made at each request, by path under the root. `on_file_request` is told of each before it is answered.
    """

    def __init__(
        self,
        name: str,
        model: str,
        points: RelayPoints,
        profile: Profile,
        clock: RelayClock,
        *,
        address: Address,
        root: Path,
        staging: Path,
        operated: Operated,
        texts: Mapping[str, TextSource],
        on_file_request: Callable[[FileRequest], None] | None,
        access: Access,
        identity: Identity,
        misbehaviour_state: MisbehaviourState,
    ) -> None:
        # All models have the same name: relays of one kind then share one text, which is checked once.
        anonymous = model.replace(f"MODEL({name}){{", f"MODEL({_ANY_NAME}){{", 1)
        self._model = sys.intern(_with_built_in(misbehaviour_state, points, anonymous))
        self._name = name
        self._points = points
        self._profile = profile
        self._clock = clock
        self._address = address
        self._root = root
        self._staging = staging
        self._operated = operated
        self._texts = texts
        self._on_file_request = on_file_request
        self._access = access
        self._identity = identity
        self._misbehaviour_state = misbehaviour_state
        self._goose: RelayGoose | None = None
        self._values: dict[str, Value | Quality] = {}
        self._stamps: dict[str, tuple[str | None, str | None]] = {}
        self._switching = threading.Lock()
        self._publishing = threading.Lock()
        self._writing_texts = threading.Lock()
        self._published_to: tuple[Server, ...] = ()
        self._down = False
        self._overflow_server: Server | None = None
        self._overflow_address: ReservedAddress | None = None
        for folder in {Path(path).parent for path in texts}:
            (root / folder).mkdir(parents=True, exist_ok=True)
        self.server = self._build(address, min(profile.sessions, MOST_CONNECTIONS))
        self._publish_to(self.server)

    def publish(self, values: Mapping[str, Value], time_ns: int, quality: Quality = GOOD) -> None:
        """Update attributes as one change, with quality and time of their data objects.

        Any thread may call this, and none waits for a server: a handler of one server may publish while
        another server is served.
        """
        changes: dict[str, Value | Quality] = dict(values)
        stamp = Timestamp(self._clock.stamped(time_ns))
        for reference in values:
            if reference not in self._stamps:
                self._stamps[reference] = self._points.stamps(reference)
            of_quality, of_time = self._stamps[reference]
            if of_quality is not None:
                changes[of_quality] = quality
            if of_time is not None:
                changes[of_time] = stamp
        with self._publishing:
            self._values |= changes
            for server in self._published_to:
                server.post(changes)
            if self._goose is not None:
                self._goose.update(changes, stamp.ns)

    def publish_goose(self, ied: Ied, outlet: GooseOutlet) -> None:
        """Send the GOOSE messages of the control blocks from now on. ied: the relay's."""
        with self._publishing:
            self._goose = RelayGoose(ied, outlet, self._values, self._clock.now_ns())

    def apply_published(self) -> None:
        """Apply to the server what was published. Raises ModelError where it does not fit.

        It waits for the server, so no handler calls it, and nobody with a lock.
        """
        self.server.apply_posted()

    def go_down(self) -> None:
        """End every connection. What clients had not yet received is forgotten."""
        with self._switching:
            self._down = True
            self._publish_to()
            self.server.stop()
            self._stop_overflow_server()

    def come_up(self) -> None:
        """Serve again, with the values as they are, on a thread of its own. Raises ServerStartFailed."""
        with self._switching:
            self.server = self._build(self._address, min(self._profile.sessions, MOST_CONNECTIONS))
            self._publish_to(self.server)
            self.server.start()
            self._down = False

    def open_overflow_server(self) -> Address | None:
        """Return where clients are served for whom the server has no session left; None while it is down.

        Raises ServerStartFailed.
        """
        with self._switching:
            if self._down:
                return None
            if self._overflow_server is None:
                self._overflow_address = self._overflow_address or ReservedAddress()
                overflow_server = self._build(
                    self._overflow_address.address, self._profile.sessions - MOST_CONNECTIONS
                )
                self._publish_to(self.server, overflow_server)
                overflow_server.start()
                self._overflow_server = overflow_server
            return Address(self._overflow_server.address, self._overflow_server.port)

    def close(self) -> None:
        """Stop the overflow server where there is one, and open none any more."""
        with self._switching:
            self._down = True
            self._publish_to(self.server)
            self._stop_overflow_server()

    def _publish_to(self, *servers: Server) -> None:
        """Publish to these servers from now on. One that is new gets all values first."""
        with self._publishing:
            for server in servers:
                if server not in self._published_to and self._values:
                    server.post(dict(self._values))
            self._published_to = servers

    def _stop_overflow_server(self) -> None:
        overflow_server, self._overflow_server = self._overflow_server, None
        if overflow_server is not None:
            overflow_server.stop()
        address, self._overflow_address = self._overflow_address, None
        if address is not None:
            address.release()

    def _build(self, address: Address, sessions: int) -> Server:
        served = self._profile.files is not None
        server = Server(
            self._model,
            ied_name=self._name if self._model.startswith(f"MODEL({_ANY_NAME})") else None,
            address=address.host,
            port=address.port,
            max_connections=sessions,
            report_buffer_bytes=self._profile.report_buffer_bytes,
            file_root=self._root if served else None,
            on_file_request=self._asked_for_file if served else None,
            tls=self._access.tls,
            passwords=self._access.passwords,
            identity=self._identity,
            dynamic_data_sets=self._profile.dynamic_data_sets,
            optional_fields_writable=Kind.REPORT_OPTFIELDS_READONLY not in self._misbehaviour_state.kinds,
        )
        unreadable = self._points.frequency
        if unreadable is not None and Kind.UNREADABLE_MEASURAND in self._misbehaviour_state.kinds:
            server.on_read(unreadable, self._measurand_error)
        for reference in self._points.controls:
            server.on_operate(reference, self._operated)
        return server

    def _measurand_error(self) -> DataAccessError | None:
        error = self._misbehaviour_state.number(Kind.UNREADABLE_MEASURAND)
        return None if error is None else DataAccessError(int(error))

    def _asked_for_file(self, request: FileRequest) -> FileAnswer:
        if self._misbehaviour_state.is_on(Kind.FILES_BUSY):
            return FileAnswer.BUSY
        self._make_texts(request)
        if self._on_file_request is not None:
            self._on_file_request(request)
        return FileAnswer.SERVE

    def _make_texts(self, request: FileRequest) -> None:
        """Write the texts that a client lists or opens, with their present content."""
        asked = request.path.relative_to(self._root.resolve()).as_posix()
        if request.operation is FileOperation.LIST:
            wanted = [path for path in self._texts if asked in (".", Path(path).parent.as_posix(), path)]
        else:
            wanted = [asked] if asked in self._texts else []
        for path in wanted:
            with self._writing_texts:
                made = self._staging / Path(path).name
                made.write_bytes(self._texts[path]())
                made.replace(self._root / path)


def _with_built_in(misbehaviour_state: MisbehaviourState, points: RelayPoints, model: str) -> str:
    """Return the model text as the misbehaviours require that a relay is built with."""
    if points.reports is None:
        return model
    block = points.reports.rpartition(".")[2]
    if Kind.REPORT_WITHOUT_DATA_SET in misbehaviour_state.kinds:
        model = without_data_set(model, block)
    fields = misbehaviour_state.built_in(Kind.REPORT_OPTFIELDS_READONLY)
    return model if fields is None else with_optional_fields(model, block, int(fields))
