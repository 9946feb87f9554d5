"""Every relay profile as a client sees it, over MMS on the loopback interface."""

import queue
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ied_sim.errors import ProfileError
from ied_sim.profiles.profile import Profile, RecordFormat, Triggers, read_profile, shipped
from ied_sim.relay.configuration import RelayConfiguration
from mms import Client, FunctionalConstraint, MmsError, NotFound, Report, Value
from scl import Scl
from testing.relays.simulated import (
    IED,
    SHORT,
    Simulated,
    fetch,
    names,
    recordings,
    scenario_of,
    simulated,
)
from testing.waiting import wait_until

CHANNELS = ["IA", "IB", "IC", "VA", "VB", "VC"]


def browsed(client: Client) -> dict[str, set[str]]:
    """Data objects by logical node, as the server tells them."""
    return {
        f"{device}/{node}": set(client.data_objects(f"{device}/{node}"))
        for device in client.logical_devices()
        for node in client.logical_nodes(device)
    }


def in_file(document: Scl) -> dict[str, set[str]]:
    nodes = document.ied(IED).logical_nodes()
    return {node.reference: {each.name for each in node.data_objects} for node in nodes}


class Told:
    """What a relay's reports tell of each data object; one report may tell of several."""

    def __init__(self, served: Simulated, client: Client) -> None:
        self._reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        self._values: dict[str, list[Value]] = {}
        block = read_profile(served.relay._configuration.profile.name).points.reports
        assert block is not None
        client.subscribe(served.reference(block), self._reports)

    def next(self, name: str) -> Value:
        """The value told next of the data object `name`."""
        while not self._values.get(name):
            for member in self._reports.get(timeout=20).members:
                told_of = (member.reference or "").rpartition("$")[2]
                if isinstance(member.value, tuple):
                    self._values.setdefault(told_of, []).append(member.value[0])
        return self._values[name].pop(0)


@pytest.mark.parametrize("profile", shipped())
def test_a_client_browses_reads_operates_and_takes_reports(profile: str, tmp_path: Path) -> None:
    scenario = scenario_of(profile)
    points = scenario.profile.points
    with simulated(tmp_path, scenario) as served, served.client() as client:
        assert browsed(client) == in_file(served.document)
        current = served.reference(f"{points.metering}.A.phsA.cVal.mag.f")
        wait_until(lambda: client.read(current, FunctionalConstraint.MX) != 0, "the first metering")
        assert client.read(current, FunctionalConstraint.MX) == pytest.approx(1.203, rel=0.02)
        assert len(client.read_data_set(client_data_set(served))) >= 1
        told = Told(served, client)
        assert points.start is not None
        assert points.stop is not None
        client.operate(served.reference(points.stop), value=True)
        wait_until(lambda: served.relay._word["STOPPED"], "the motor to stop")
        client.operate(served.reference(points.start), value=True)
        assert served.relay._word["STARTING"]
        served.relay._trip(["overcurrent"], served.relay._clock.now_ns())
        assert told.next("Tr") is True


def client_data_set(served: Simulated) -> str:
    return served.document.ied(IED).data_sets()[0].reference


@pytest.mark.parametrize("profile", ["sel-710-ed2", "sel-710-ed1", "rdre"])
def test_a_client_triggers_a_record_and_fetches_it(profile: str, tmp_path: Path) -> None:
    scenario = scenario_of(profile)
    files, points = scenario.profile.files, scenario.profile.points
    assert files is not None
    with simulated(tmp_path / "relay", scenario) as served, served.client() as client:
        client.operate(served.reference(points.trigger[-1]), value=True)
        suffixes = {path.kind for path in scenario.profile.record.written()}
        wait_until(lambda: any(".C" in name for name in names(client, files.folder)), "a record")
        found = recordings(fetch(client, files.folder, tmp_path / "fetched"))
    assert len(found) == len(suffixes)
    for recording in found:
        assert [channel.name for channel in recording.channels][:6] == CHANNELS
        rms = np.sqrt(np.mean(recording.samples[:3] ** 2, axis=1))
        assert rms == pytest.approx([1.203] * 3, rel=0.03)
        assert recording.trigger_index == 64
        assert recording.digitals is not None
        assert "RB01" in recording.digitals.names


def test_edition_1_tells_of_a_record_by_files_alone(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed1")) as served, served.client() as client:
        assert not served.document.ied(IED).data_objects(ln_class="RDRE")
        bit = served.reference("CON/RBGGIO1.SPCSO01")
        client.operate(bit, value=True)
        client.operate(bit, value=False)
        wait_until(lambda: "EVENTS/HR_10000.CFG" in names(client, "EVENTS"), "a record")
        assert names(client, "EVENTS") == [
            f"EVENTS/HR_10000.{suffix}" for suffix in ("CEV", "CFG", "DAT", "HDR")
        ]


def test_a_pulse_bit_falls_by_itself_and_triggers(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served, served.client() as client:
        told = Told(served, client)
        bit = served.reference("CON/PRBGGIO1.SPCSO01")
        client.operate(bit, value=True)
        assert told.next("RcdMade") is True
        assert client.read(f"{bit}.stVal", FunctionalConstraint.ST) is False


def test_rcd_trg_announces_lists_with_backslashes_and_clears(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("rdre")) as served, served.client() as client:
        told = Told(served, client)
        client.operate(served.reference("Rec_FaultRecorder/DEF_RDRE1.RcdTrg"), value=True)
        assert told.next("RcdStr") is True
        assert told.next("RcdMade") is True
        assert names(client, "COMTRADE") == [
            f"COMTRADE\\FRA10000.{suffix}" for suffix in ("CFG", "DAT", "HDR")
        ]
        assert names(client, "\\COMTRADE\\")
        client.operate(served.reference("Rec_FaultRecorder/DEF_RDRE1.MemClr"), value=True)
        assert names(client, "COMTRADE") == []


def test_a_record_ends_after_it_was_told_to_begin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However late the values of its begin are published: else RcdMade would fall again."""
    scenario = scenario_of("rdre")
    scenario = replace(scenario, triggers=Triggers(load_above=0.1))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        publish = served.relay._values.publish_status

        def slowly(values: dict[str, Value], time_ns: int) -> None:
            if values.get("record_started"):
                time.sleep(SHORT.post_trigger_s + 1.0)
            publish(values, time_ns)

        monkeypatch.setattr(served.relay._values, "publish_status", slowly)
        told = Told(served, client)
        assert [told.next("RcdStr"), told.next("RcdStr")] == [True, False]
        assert told.next("RcdMade") is True
        made = served.reference("Rec_FaultRecorder/DEF_RDRE1.RcdMade.stVal")
        assert client.read(made, FunctionalConstraint.ST) is True


def test_a_recorder_without_rcd_trg_records_a_motor_start(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("rdre-readonly")) as served, served.client() as client:
        assert served.document.ied(IED).find("DR/DRRDRE1.RcdTrg") is None
        told = Told(served, client)
        client.operate(served.reference("DR/MOTGGIO1.SPCSO02"), value=True)
        client.operate(served.reference("DR/MOTGGIO1.SPCSO01"), value=True)
        assert told.next("RcdMade") is True
        (recording,) = recordings(fetch(client, "COMTRADE", tmp_path / "fetched"))
    before = np.abs(recording.samples[:3, : recording.trigger_index]).max()
    assert np.abs(recording.samples[:3, recording.trigger_index :]).max() > 5 * 1.203
    assert before < 12


def test_a_relay_without_files_says_so(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("files-none")) as served, served.client() as client:
        client.operate(served.reference("CON/RBGGIO1.SPCSO01"), value=True)
        with pytest.raises(MmsError):
            client.files("")


@pytest.mark.parametrize(
    ("written", "suffixes"),
    [
        ("COMTRADE 1991 ASCII", ["CFG", "DAT", "HDR"]),
        ("COMTRADE 1991 BINARY", ["CFG", "DAT", "HDR"]),
        ("COMTRADE 1999 ASCII", ["CFG", "DAT", "HDR"]),
        ("COMTRADE 2013 BINARY32", ["CFG", "DAT", "HDR"]),
        ("COMTRADE 2013 FLOAT32", ["CFG", "DAT", "HDR"]),
        ("CFF BINARY", ["CFF"]),
        ("CFF ASCII", ["CFF"]),
        ("CEV", ["CEV"]),
    ],
)
def test_every_format_is_written_and_read(written: str, suffixes: list[str], tmp_path: Path) -> None:
    of_profile = scenario_of("sel-710-ed2")
    record = of_profile.profile.record.model_copy(update={"formats": (written,)})
    profile = of_profile.profile.model_copy(update={"record": record})
    scenario = replaced(of_profile, profile)
    with simulated(tmp_path / "relay", scenario) as served, served.client() as client:
        client.operate(served.reference("CON/RBGGIO1.SPCSO01"), value=True)
        last = f"EVENTS/HR_10000.{suffixes[0]}"
        wait_until(lambda: last in names(client, "EVENTS"), "a record")
        fetched = fetch(client, "EVENTS", tmp_path / "fetched")
    assert [path.suffix[1:] for path in fetched] == suffixes
    (recording,) = recordings(fetched)
    assert recording.samples.shape == (6, round(SHORT.sample_rate_hz * 0.12))
    assert recording.repairs == ()


def replaced(scenario: object, profile: object) -> "RelayConfiguration":
    assert isinstance(scenario, RelayConfiguration)
    assert isinstance(profile, Profile)
    return replace(scenario, profile=profile)


def test_a_user_writes_a_profile(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    text = (read_profile("sel-710-ed1").path).read_text(encoding="utf-8")
    icd = read_profile("sel-710-ed1").icd_path
    own.write_text(text.replace("sel-710-ed1.icd", str(icd)).replace("cycles = 64", "cycles = 15"))
    profile = read_profile("own.toml", beside=tmp_path)
    assert (profile.name, profile.record.cycles) == ("own", 15)
    assert profile.record.written()[0] == RecordFormat("CEV")
    scenario = replace(scenario_of("sel-710-ed1"), profile=profile)
    with simulated(tmp_path / "relay", scenario) as served, served.client() as client:
        client.operate(served.reference("CON/RBGGIO1.SPCSO01"), value=True)
        wait_until(lambda: "EVENTS/HR_10000.CEV" in names(client, "EVENTS"), "a record")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("cycles = 64", "cycles = 0", r"own.toml: record.cycles: expected greater than 0, found 0"),
        ("cycles = 64", "cycle = 64", r"own.toml: record.cycles: expected this field, found nothing"),
        ("capacity = 20", "capacity = 20\nsize = 3", r"own.toml: record.size: expected no such field"),
        ('"CEV", ', '"CSV", ', r"own.toml: record: expected formats are"),
        ("COMTRADE 1999 BINARY", "COMTRADE 1999 FLOAT32", r"COMTRADE 1999 has no FLOAT32; 2013 has"),
        ("samples_per_cycle = 32", "samples_per_cycle = 33", r"own.toml: record.samples_per_cycle"),
        ('["CON/RBGGIO1.SPCSO01"]', '["RB01"]', r"own.toml: points.trigger.0"),
        ("sel-710-ed1.icd", "none.icd", r"own.toml: icd: expected an ICD file beside the profile"),
        ("[points]", "[points", r"own.toml: file: expected TOML"),
        ('"MOT"]', '"MOTOR"]', r"own.toml: files.reports.7"),
    ],
)
def test_what_is_wrong_with_a_profile_is_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    shipped_profile = read_profile("sel-710-ed1").path
    (tmp_path / "sel-710-ed1.icd").write_bytes((shipped_profile.parent / "sel-710-ed1.icd").read_bytes())
    content = shipped_profile.read_text(encoding="utf-8")
    assert old in content
    (tmp_path / "own.toml").write_text(content.replace(old, new), encoding="utf-8")
    with pytest.raises(ProfileError, match=message):
        read_profile("own.toml", beside=tmp_path)


def test_an_unknown_profile_names_those_there_are() -> None:
    with pytest.raises(ProfileError, match=r"one of files-none, .*sel-710-ed2.*found siprotec"):
        read_profile("siprotec")


def test_a_model_that_is_not_that_of_its_profile_is_served_and_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """What stands under the standard name is taken; the rest is left out."""
    profile = read_profile("sel-710-ed1")
    points = profile.points.model_copy(
        update={"record_made": "PRO/FLTRDRE1.RcdMade", "trigger": ("CON/PRBGGIO1.SPCSO01",)}
    )
    scenario = replaced(scenario_of("sel-710-ed1"), profile.model_copy(update={"points": points}))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        client.operate(served.reference("CON/RBGGIO1.SPCSO01"), value=True)
        wait_until(lambda: names(client, "EVENTS"), "a record")
    told = "trigger is CON/RBGGIO1.SPCSO01; no record_made"
    assert f"R1: not all points of sel-710-ed1 are in its model: {told}" in caplog.text


def test_a_control_the_relay_lacks_is_refused_to_the_client(tmp_path: Path) -> None:
    with (
        simulated(tmp_path, scenario_of("rdre-readonly")) as served,
        served.client() as client,
        pytest.raises(NotFound),
    ):
        client.operate(served.reference("DR/DRRDRE1.RcdTrg"), value=True)
