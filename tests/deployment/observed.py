"""The running containers, as somebody outside sees them."""

import time
from collections.abc import Callable, Mapping

from service.client.rest_client import ServiceClient, ServiceError
from testing.service.processes import MOTOR_NAMES, link_states
from tests.deployment.composing import Compose
from tests.deployment.transfers import Transfer, require_once_each, transfers

START_LIMIT_S = 300.0
DIAGNOSIS_LIMIT_S = 120.0

Recordings = Mapping[str, tuple[str, str]]
"""(motor, time of the recording) by identifier."""


class Enterprise:
    """All of it, by its compose command and its API."""

    def __init__(self, compose: Compose, service: ServiceClient) -> None:
        self.compose = compose
        self.service = service
        self.token = ""
        self._earlier: list[Transfer] = []

    def log_in(self) -> None:
        """Show the token that the first start has made, or the one after a database was put back."""
        printed = self.compose.inside("mcc", "cat", "/token/demo")
        (self.token,) = (line for line in printed.splitlines() if line.startswith("mcc_"))
        self.service = ServiceClient(f"http://127.0.0.1:{self.compose.port}", token=self.token)

    def wait(self, what: str, condition: Callable[[], bool], limit_s: float) -> None:
        """Until it is so; AssertionError when that takes too long."""
        deadline_s = time.monotonic() + limit_s
        while time.monotonic() < deadline_s:
            try:
                if condition():
                    return
            except ServiceError:
                pass  # it is being restarted
            time.sleep(0.5)
        raise AssertionError(f"not within {limit_s:g} s: {what}; links: {self.links()}")

    def links(self) -> Mapping[str, str]:
        return link_states(self.service)

    def wait_for_links(self) -> None:
        def all_up() -> bool:
            return self.service.is_ready() and set(self.links().values()) == {"up"}

        self.wait("the service is ready and every relay answers", all_up, START_LIMIT_S)

    def recordings(self, motor: str | None = None) -> Recordings:
        """Those of a motor, or of all, once each that was fetched is read, which tells its time."""
        query = {} if motor is None else {"motor": motor}
        rows: list[Mapping[str, object]] = []

        def are_read() -> bool:
            rows[:] = self.service.items("/recordings", **query)
            return all(row["state"] != "fetched" for row in rows)

        self.wait("every record that was fetched is read", are_read, DIAGNOSIS_LIMIT_S)
        return {str(row["id"]): (str(row["motor"]), str(row["recorded_time"])) for row in rows}

    def trend(self, motor: str) -> list[str]:
        """Times of its points, as told: oldest first."""
        return [str(point["time"]) for point in self.service.items(f"/motors/{motor}/trend")]

    def trigger(self, *motors: str) -> None:
        """Over REST; each comes to one diagnosis of one more recording."""
        before = self.recordings()
        requests = {motor: str(self.service.request_recording(motor)["id"]) for motor in motors}

        def ended() -> bool:
            states = {self.service.get_event_report(request)["state"] for request in requests.values()}
            assert "failed" not in states, [
                self.service.get_event_report(request) for request in requests.values()
            ]
            return states == {"diagnosed"}

        self.wait(f"diagnoses of {', '.join(motors)}", ended, DIAGNOSIS_LIMIT_S)
        new = [motor for one, (motor, _) in self.recordings().items() if one not in before]
        assert sorted(new) == sorted(motors), f"one more recording each, found {new}"

    def require_right_verdicts(self) -> None:
        status = self.compose.document("mcc", "mcc", "demo-status", "--json")
        assert status["right"] == len(MOTOR_NAMES), status
        shown = self.compose.once("mcc", "mcc", "demo-status")
        assert all(motor in shown for motor in MOTOR_NAMES), shown

    def keep_log(self) -> None:
        """Before `down` takes it away: stops the MCC, and remembers what its log says of transfers."""
        self.compose("stop", "mcc")
        self._earlier += transfers(self.compose("logs", "mcc"))

    def down(self, *options: str) -> None:
        """Take all down; nothing is left."""
        self.keep_log()
        self.compose("down", *options)
        left = self.compose.containers()
        assert not left, f"down, but there is still {left}"

    def require_continuation(self, before: Recordings) -> None:
        """All earlier recordings are there, none came twice, and none was transferred twice."""
        now = self.recordings()
        assert before.items() <= now.items()
        assert len(set(now.values())) == len(now), sorted(now.values())
        pulled = [str(row["id"]) for row in self.service.items("/recordings") if row["source"] == "relay"]
        require_once_each(self._earlier + transfers(self.compose("logs", "mcc")), pulled)
