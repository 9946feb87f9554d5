"""Relays that are busy, have a measurand that cannot be read, or report blocks that cannot be used fully."""

import queue
from pathlib import Path

import pytest

from ied_sim.errors import ScenarioError
from ied_sim.misbehaviour import PARAMETERS, Kind, Misbehaviour
from ied_sim.scenario.scenario import read_scenario
from mms import BitString, Client, FunctionalConstraint, MmsError, NotFound, Report, TemporarilyUnavailable
from testing.relays.simulated import IED, names, scenario_of, simulated
from tests.ied_sim.relay.test_misbehaviour import REPORTS, SWITCH, TRIGGER, by_switch, switch
from tests.ied_sim.scenario.test_scenario import MINIMAL

METERS = f"{IED}MET/METMMXU1"
RESOURCE = 40  # MMS_ERROR_RESOURCE_OTHER


def from_the_start(kind: Kind) -> Misbehaviour:
    return Misbehaviour(kind, PARAMETERS.get(kind, ("", 0.0))[1], at_s=0.0)


def test_a_relay_is_busy_with_its_files(tmp_path: Path) -> None:
    with (
        simulated(tmp_path, scenario_of("sel-710-ed2", by_switch(Kind.FILES_BUSY))) as served,
        served.client() as client,
    ):
        switch(client, on=True)
        with pytest.raises(TemporarilyUnavailable) as refused:
            client.files("EVENTS")
        assert refused.value.code == RESOURCE
        switch(client, on=False)
        assert names(client, "REPORTS")


def test_a_relay_is_too_busy_to_tell_values_and_still_takes_controls(tmp_path: Path) -> None:
    with (
        simulated(tmp_path, scenario_of("sel-710-ed2", by_switch(Kind.READS_BUSY))) as served,
        served.client() as client,
    ):
        switch(client, on=True)
        with pytest.raises(TemporarilyUnavailable) as refused:
            client.read(f"{TRIGGER}.stVal", FunctionalConstraint.ST)
        assert refused.value.code == RESOURCE
        with pytest.raises(MmsError):
            client.subscribe(REPORTS, queue.SimpleQueue[Report]())
        switch(client, on=False)
        assert client.read(f"{TRIGGER}.stVal", FunctionalConstraint.ST) is False


def test_one_measurand_cannot_be_read(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", by_switch(Kind.UNREADABLE_MEASURAND))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        assert client.read(f"{METERS}.Hz.mag.f", FunctionalConstraint.MX) is not None
        switch(client, on=True)
        with pytest.raises(MmsError):
            client.read(f"{METERS}.Hz.mag.f", FunctionalConstraint.MX)
        assert client.read(f"{METERS}.A.phsA.cVal.mag.f", FunctionalConstraint.MX) is not None


def test_optional_fields_of_reports_are_fixed(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", from_the_start(Kind.REPORT_OPTFIELDS_READONLY))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        sequence_number_and_reason = BitString.of(0b1010, 10)
        assert _attribute(client, "OptFlds") == sequence_number_and_reason
        reports = queue.SimpleQueue[Report]()
        client.subscribe(REPORTS, reports, general_interrogation=True)
        report = reports.get(timeout=5)
        assert report.members
        assert (report.data_set, report.entry_id, report.timestamp_ns) == (None, None, None)
        assert _attribute(client, "OptFlds") == sequence_number_and_reason


def test_a_report_block_has_no_data_set(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", from_the_start(Kind.REPORT_WITHOUT_DATA_SET))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        assert _attribute(client, "DatSet") == ""
        with pytest.raises(NotFound, match="no data set"):
            client.subscribe(REPORTS, queue.SimpleQueue[Report]())


def _attribute(client: Client, name: str) -> object:
    return client.read(f"{REPORTS.replace('.BR.', '.')}.{name}", FunctionalConstraint.BR)


@pytest.mark.parametrize("line", ["at_s = 3", "for_s = 3", f'switch = "{SWITCH}"'])
def test_what_a_relay_is_built_with_cannot_be_switched(tmp_path: Path, line: str) -> None:
    path = tmp_path / "scenario.toml"
    table = f'[[motor.misbehaviour]]\nkind = "report-without-data-set"\n{line}\n'
    path.write_text(f"{MINIMAL}{table}", encoding="utf-8")
    with pytest.raises(ScenarioError, match="it is there from the start"):
        read_scenario(path)
