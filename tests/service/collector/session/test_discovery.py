"""Relays that are not what their SCL says, over real MMS: told, not fatal, and used as they are."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

import scl
from ied_sim.profiles.profile import read_profile
from ied_sim.profiles.standalone import standalone
from mms import Client
from scl import Address
from scl.ied_model import Ied
from service.collector.session.browsing import browse
from service.configuration.toml_lines import TomlLines
from service.plant import Overrides, TriggerAction, differences
from service.plant.motors_file import MotorsFile
from service.plant.offer import node_class, offer_from_scl
from service.plant.relay_entry import RelayEntry
from service.plant.relays import relay_without_scl
from service.storage.states import AlarmKind, LinkState, RecordingRequestState
from testing.ports import LOOPBACK
from testing.relays.simulated import IED, scenario_of, simulated
from testing.waiting import eventually
from tests.service.collector.busy_front import busy_front
from tests.service.collector.conftest import Bench
from tests.service.collector.expectations import at, expecting
from tests.service.collector.scripted_relay import NAME, ScriptedRelay


def scl_of(profile: str, name: str = IED) -> Ied:
    return standalone(read_profile(profile), name, Address("127.0.0.1", 102)).ied(name)


def acquisition(bench: Bench) -> Mapping[str, object]:
    """What is used of the relay; empty before the first visit."""
    findings = bench.repository.relay_findings(NAME)
    return {} if findings is None else findings.acquisition


def found_differences(bench: Bench) -> set[tuple[object, object, object]]:
    findings = bench.repository.relay_findings(NAME)
    assert findings is not None
    return {(each["kind"], each["expected"], each["found"]) for each in findings.differences}


def visited(bench: Bench) -> bool:
    return bench.repository.relay_findings(NAME) is not None and bench.link() is LinkState.UP


def granted(bench: Bench) -> bool:
    """Whether a request becomes a stored record."""
    request_id = bench.request()
    return eventually(lambda: bench.requested(request_id).state is RecordingRequestState.FETCHED, 20)


def refusal(bench: Bench) -> str:
    """Why a request is not granted."""
    request_id = bench.request()
    assert eventually(lambda: bench.requested(request_id).state is RecordingRequestState.FAILED)
    assert bench.requested(request_id).triggered_ns is None, "nothing was operated"
    return bench.requested(request_id).reason or ""


@pytest.mark.parametrize("profile", ["sel-710-ed2", "sel-710-ed1", "rdre", "rdre-readonly", "files-none"])
def test_a_relay_as_its_scl_says_differs_in_nothing(tmp_path: Path, profile: str) -> None:
    with simulated(tmp_path / "relays", scenario_of(profile)) as served, served.client() as client:
        expected = offer_from_scl(served.document.ied(IED))
        offer = browse(client, expected)
    assert offer is not None
    assert differences(expected, offer) == ()
    assert set(offer.report_blocks) == set(expected.report_blocks)


def test_a_relay_newer_than_its_scl_tells_of_its_records(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2")) as served:
        here = at(expecting(bench, scl_of("sel-710-ed1")), served)
        assert here.relay.record_made is None
        here.with_settings(poll_period_s=60.0)
        with here.session():
            assert eventually(lambda: visited(here))
            with served.client() as client:
                client.operate(f"{IED}CON/RBGGIO1.SPCSO01", value=True)
            assert eventually(lambda: len(here.recordings()) == 1), "a report hurries the scan"
    found = acquisition(here)
    assert found["records_told_by"] == "buffered-report"
    assert found["record_made"] == f"{IED}PRO/FLTRDRE1.RcdMade"
    assert found["control_model"] == "direct-with-normal-security"
    assert ("logical-node", None, f"{IED}PRO/FLTRDRE1") in found_differences(here)
    assert here.alarms() == {}, "more than expected harms nobody"


def test_a_relay_without_any_scl_file_is_asked_what_it_offers(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2")) as served:
        nothing = RelayEntry(NAME, host=served.address.host, port=served.address.port)
        told = MotorsFile(Path("motors.toml"), {}, {}, {}, TomlLines(""), {})
        relay = relay_without_scl(nothing, "FACTORY_A", told, Overrides())
        here = replace(at(bench, served), relay=relay)
        with here.session():
            assert eventually(lambda: visited(here))
            assert granted(here)
        assert here.alarms() == {}, "nothing was promised"
    found = acquisition(here)
    assert found["trigger"] == f"{IED}CON/RBGGIO1.SPCSO01"
    assert found["records_told_by"] == "buffered-report"
    assert found_differences(here) == set()


def test_a_relay_older_than_its_scl_is_polled(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed1")) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2")), served)
        with here.session():
            assert eventually(lambda: visited(here))
            assert granted(here)
            assert here.alarms() == {AlarmKind.RELAY_DIFFERS: ["record-made", "reports"]}
    assert acquisition(here)["records_told_by"] == "polling"
    assert ("logical-node", f"{IED}PRO/FLTRDRE1", None) in found_differences(here)
    findings = here.repository.relay_findings(NAME)
    assert findings is not None
    assert len(here.recordings()) == 1
    name = here.recordings()[0].name
    assert [(file["name"], file["reason"]) for file in findings.ignored_files] == [
        (f"{name}.CEV", f"the same event as {name}.CFG, {name}.DAT, {name}.HDR, which is taken")
    ]


def test_an_icd_that_cannot_know_the_relays_name_raises_no_alarm(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2")) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2", "A9")), served)
        here = replace(here, relay=replace(here.relay, scl_knows_names=False))
        with here.session():
            assert eventually(lambda: visited(here))
        assert here.alarms() == {}
    assert acquisition(here)["trigger"] == f"{IED}CON/RBGGIO1.SPCSO01"


def test_a_relay_under_another_name_is_used_under_its_own(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2")) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2", "A9")), served)
        with here.session():
            assert eventually(lambda: visited(here))
            assert granted(here)
            assert "trigger" in here.alarms()[AlarmKind.RELAY_DIFFERS]
    assert acquisition(here)["trigger"] == f"{IED}CON/RBGGIO1.SPCSO01"
    assert acquisition(here)["report_control"] == f"{IED}CFG/LLN0.BR.BRep01"
    renamed = {
        ("logical-device", f"A9{inst}", f"{IED}{inst}") for inst in ("CFG", "PRO", "MET", "CON", "ANN")
    }
    assert found_differences(here) == renamed


def test_a_relay_of_another_make_is_used_as_it_is(bench: Bench, tmp_path: Path) -> None:
    """RcdTrg in the place of a remote bit, a pulse, and another folder than the setting's."""
    with simulated(tmp_path / "relays", scenario_of("rdre")) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2")), served)
        with here.session():
            assert eventually(lambda: visited(here))
            assert granted(here)
            assert granted(here), "the trigger is ready again"
    found = acquisition(here)
    assert found["trigger"] == f"{IED}Rec_FaultRecorder/DEF_RDRE1.RcdTrg"
    assert found["trigger_action"] == "pulse"
    assert found["events_directory"] == "COMTRADE"


def test_a_relay_that_cannot_be_triggered_says_so_at_once(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("rdre-readonly")) as served:
        here = at(expecting(bench, scl_of("rdre-readonly")), served)
        with here.session():
            assert eventually(lambda: visited(here))
            assert "it records what it records itself" in refusal(here)
            with served.client() as client:
                client.operate(f"{IED}DR/MOTGGIO1.SPCSO02", value=True)
                client.operate(f"{IED}DR/MOTGGIO1.SPCSO01", value=True)
            assert eventually(lambda: len(here.recordings()) == 1)
    assert acquisition(here)["records_told_by"] == "buffered-report"
    assert here.alarms() == {}, "its SCL promised no trigger"


def test_a_relay_without_files_is_up_and_says_what_it_lacks(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("files-none")) as served:
        here = at(expecting(bench, scl_of("files-none")), served)
        with here.session():
            assert eventually(lambda: visited(here))
            assert "the relay offers no files" in refusal(here)
            assert "the relay offers no files" in (here.repository.relay(NAME).link_reason or "")
    assert acquisition(here)["events_directory"] is None


def test_report_blocks_and_data_sets_of_other_names_are_found(bench: Bench, relay: ScriptedRelay) -> None:
    ied = renamed_in_scl(bench, ("BRep0", "BufRep0"), ("DSet01", "DSetEvents"))
    here = expecting(bench, ied)
    with here.session():
        assert eventually(lambda: visited(here))
        assert here.alarms() == {AlarmKind.RELAY_DIFFERS: ["reports"]}
    assert acquisition(here)["report_control"] == f"{NAME}CFG/LLN0.BR.BRep01"
    node = f"{NAME}CFG/LLN0"
    assert {
        ("data-set", f"{node}.DSetEvents", None),
        ("data-set", None, f"{node}.DSet01"),
        ("report-control", f"{node}.BR.BufRep01", None),
        ("report-control", None, f"{node}.BR.BRep01"),
        ("report-control", f"{node}.RP.URep03: {node}.DSetEvents", f"{node}.RP.URep03: {node}.DSet01"),
    } <= found_differences(here)


def renamed_in_scl(bench: Bench, *renamed: tuple[str, str]) -> Ied:
    """The relay's SCL with other names."""
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8")
    for old, new in renamed:
        text = text.replace(f'"{old}', f'"{new}')
    path = bench.settings.data_directory / "other.scd"
    path.write_text(text, encoding="utf-8")
    return scl.read(path).ied(NAME)


def test_findings_change_with_the_relay_and_alarms_end(bench: Bench, relay: ScriptedRelay) -> None:
    with expecting(bench, renamed_in_scl(bench, ("BRep0", "BufRep0"))).session():
        assert eventually(lambda: visited(bench))
        assert bench.alarms() == {AlarmKind.RELAY_DIFFERS: ["reports"]}
    right = expecting(bench, scl.read(scl.DEMO_PLANT_SCD).ied(NAME))
    with right.session():
        assert eventually(lambda: found_differences(bench) == set())
        assert bench.alarms() == {}


@pytest.mark.parametrize(
    ("overrides", "used"),
    [
        (
            Overrides(trigger=f"{NAME}CON/RBGGIO1.SPCSO02", trigger_action=TriggerAction.PULSE),
            {"trigger": f"{NAME}CON/RBGGIO1.SPCSO02", "trigger_action": "pulse"},
        ),
        (
            Overrides(report_control=f"{NAME}CFG/LLN0.RP.URep03"),
            {"report_control": f"{NAME}CFG/LLN0.RP.URep03", "records_told_by": "unbuffered-report"},
        ),
        (Overrides(report_control="none"), {"report_control": None, "records_told_by": "polling"}),
        (Overrides(events_directory="EVENTS/"), {"events_directory": "EVENTS/"}),
    ],
    ids=["trigger", "report", "no report", "folder"],
)
def test_the_motors_file_decides(
    bench: Bench, relay: ScriptedRelay, overrides: Overrides, used: dict[str, object]
) -> None:
    here = expecting(bench, scl.read(scl.DEMO_PLANT_SCD).ied(NAME), overrides)
    relay.write_record("HR_1")
    with here.session():
        assert eventually(lambda: here.is_stored("HR_1"))
        assert eventually(lambda: used.items() <= acquisition(here).items())
    assert here.alarms() == {}


def test_a_trigger_that_was_ruled_out_or_does_not_exist(bench: Bench, relay: ScriptedRelay) -> None:
    ied = scl.read(scl.DEMO_PLANT_SCD).ied(NAME)
    with expecting(bench, ied, Overrides(trigger="none")).session():
        assert "the motors file says that it is not to be triggered" in refusal(bench)
    with expecting(bench, ied, Overrides(trigger=f"{NAME}CON/RBGGIO9.SPCSO01")).session():
        assert eventually(lambda: bench.alarms() == {AlarmKind.RELAY_DIFFERS: ["trigger"]})
        request_id = bench.request()
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert "refuses the trigger" in (bench.requested(request_id).reason or "")
    assert relay.edges == 0


def test_browsing_is_cheap(relay: ScriptedRelay) -> None:
    """Two requests a logical device, and one for each data set and report block."""
    with busy_front(relay.port, {}) as front, Client.connect(LOOPBACK, front.port) as client:
        devices = len(client.logical_devices())
        assert len(front.asked) == 1
        offer = browse(client, None)
        assert offer is not None
        assert len(front.asked) == 1 + 2 * devices + len(offer.data_sets) + len(offer.report_blocks)


@pytest.mark.parametrize(
    ("name", "ln_class"),
    [("FLTRDRE1", "RDRE"), ("DEF_RDRE12", "RDRE"), ("MMXU", "MMXU"), ("LLN0", None), ("x1", None)],
)
def test_the_class_of_a_node_is_in_its_name(name: str, ln_class: str | None) -> None:
    assert node_class(name) == ln_class


def test_a_device_of_quite_another_name_is_known_by_its_nodes() -> None:
    expected = offer_from_scl(scl_of("rdre"))
    other = replace(
        expected,
        nodes={node.replace("R1Mot1/", "QQ/"): names for node, names in expected.nodes.items()},
        data_sets={
            data_set: tuple(member.replace("R1Mot1/", "QQ/") for member in members)
            for data_set, members in expected.data_sets.items()
        },
    )
    found = differences(expected, other)
    assert [(each.expected, each.found) for each in found] == [("R1Mot1", "QQ")]
