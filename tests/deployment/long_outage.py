"""A link that is down until the relay discards records: what is lost, how that shows, how it is mended."""

import base64
import io
import json
import zipfile
from collections.abc import Mapping

import httpx

from ied_sim.scenario.scenario import read_scenario
from service.client.credentials import bearer
from service.demo import SCENARIO
from tests.deployment.observed import START_LIMIT_S, Enterprise

MOTOR, RELAY = "COMPRESSOR-B2", "B2_SEL710"
LIMIT_S = 60.0

RECORD_AND_TAKE_THE_FIRST = """
import base64, io, json, sys, time, scl
from mms import Client
ied, count = sys.argv[1], int(sys.argv[2])
address = scl.read("/plant/plant.scd").seen_from("FACTORY_B").address(ied)
with Client.connect(address.host, address.port) as relay:
    def listed():
        return {file.name for file in relay.files("EVENTS")}
    for number in range(count):
        before = listed()
        relay.operate(f"{ied}CON/RBGGIO1.SPCSO01", True)
        relay.operate(f"{ied}CON/RBGGIO1.SPCSO01", False)
        while not any(name.endswith(".CFG") for name in listed() - before):
            time.sleep(0.1)
        if number == 0:
            taken = {}
            for name in sorted(listed() - before):
                content = io.BytesIO()
                relay.download(name if "/" in name else f"EVENTS/{name}", content)
                taken[name.rpartition("/")[2]] = base64.b64encode(content.getvalue()).decode()
            print(json.dumps({"taken": taken}))
"""
"""In the factory: so many records by the relay's button, and a person who takes the first with them."""


def a_link_down_for_long_costs_what_the_relay_discards(enterprise: Enterprise) -> None:
    held = read_scenario(SCENARIO)[RELAY].recorder.capacity
    before, points = enterprise.recordings(), enterprise.trend(MOTOR)
    enterprise.compose("stop", "router-b")
    enterprise.wait("its link is down", lambda: enterprise.links()[RELAY] == "down", START_LIMIT_S)
    asked = str(enterprise.service.request_recording(MOTOR)["id"])
    script = ("python", "-c", RECORD_AND_TAKE_THE_FIRST, RELAY, str(held + 1))
    printed = enterprise.compose.inside("relay-b2", *script).splitlines()
    taken = json.loads(next(line for line in printed if line.startswith('{"taken"')))["taken"]
    first = {name: base64.b64decode(content) for name, content in taken.items()}
    _require_in_vain(enterprise, asked)

    enterprise.compose("start", "router-b")
    enterprise.wait_for_links()
    enterprise.wait(
        "a point for each record the relay holds",
        lambda: len(enterprise.trend(MOTOR)) >= len(points) + held,
        2 * START_LIMIT_S,
    )
    rows = [row for row in enterprise.service.items("/recordings", motor=MOTOR) if row["id"] not in before]
    numbers = sorted(_number(str(row["name"])) for row in rows)
    (lost,) = {_number(name) for name in first}
    assert numbers == list(range(lost + 1, lost + 1 + held)), "the gap in the numbers is what was lost"

    status, recording = _upload(enterprise, {n: c for n, c in first.items() if not n.endswith(".HDR")})
    assert (status, recording["name"]) == (201, f"HR_{lost}")
    enterprise.wait(
        "the point of the upload",
        lambda: len(enterprise.trend(MOTOR)) == len(points) + held + 1,
        START_LIMIT_S,
    )
    details = enterprise.service.get(f"/recordings/{recording['id']}")
    later = sorted(str(row["recorded_time"]) for row in rows)
    assert enterprise.trend(MOTOR) == [*points, str(details["recorded_time"]), *later], "in its place"
    enterprise.require_continuation(before)


def an_upload_of_what_is_known_changes_nothing(enterprise: Enterprise) -> None:
    before, points = enterprise.recordings(), enterprise.trend(MOTOR)
    for known in list(enterprise.service.items("/recordings", motor=MOTOR))[:2]:
        files = _download(enterprise, str(known["id"]))
        renamed = {
            f"ON SITE{name[-4:]}": content for name, content in files.items() if not name.endswith(".HDR")
        }
        for again in (files, renamed):
            status, recording = _upload(enterprise, again)
            assert (status, recording["id"]) == (200, known["id"])
    assert (enterprise.recordings(), enterprise.trend(MOTOR)) == (before, points)


def _require_in_vain(enterprise: Enterprise, asked: str) -> None:
    """A recording request that the relay could not be asked for ends, and says why."""

    def has_failed() -> bool:
        return enterprise.service.get_event_report(asked)["state"] == "failed"

    enterprise.wait("the recording request fails", has_failed, START_LIMIT_S)
    reason = str(enterprise.service.get_event_report(asked)["reason"])
    assert "router-b:10214" in reason, reason


def _number(name: str) -> int:
    return int(name.removeprefix("HR_").partition(".")[0])


def _download(enterprise: Enterprise, recording: str) -> dict[str, bytes]:
    answer = httpx.get(
        f"{_recordings(enterprise)}/{recording}/file",
        timeout=LIMIT_S,
        trust_env=False,
        headers=bearer(enterprise.token),
    )
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _upload(enterprise: Enterprise, files: Mapping[str, bytes]) -> tuple[int, Mapping[str, object]]:
    answer = httpx.post(
        _recordings(enterprise),
        data={"motor": MOTOR},
        files=[("files", (name, content)) for name, content in files.items()],
        timeout=LIMIT_S,
        trust_env=False,
        headers=bearer(enterprise.token),
    )
    document = answer.json()
    assert isinstance(document, dict)
    return answer.status_code, document


def _recordings(enterprise: Enterprise) -> str:
    return f"http://127.0.0.1:{enterprise.compose.port}/api/v1/recordings"
