"""Text reports, made at each request of what the simulated motor did."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.recordings.cev.compressed_ascii import rows
from core.recordings.repairs import Repairs
from core.relay_reports import (
    read_load_profile,
    read_motor_starts,
    read_motor_statistics,
    read_sequence_of_events,
)
from ied_sim.motor.contactor import Contactor
from ied_sim.profiles.profile import Triggers
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.protection import DefiniteTime, ProtectionSettings, ThermalOverload
from mms import Client, FunctionalConstraint
from testing.relays.simulated import IED, Simulated, fetch, names, recordings, scenario_of, simulated, text
from testing.waiting import wait_until


def stopped(scenario: RelayConfiguration) -> RelayConfiguration:
    """The same with a motor that stands at first."""
    return replace(scenario, plant=replace(scenario.plant, contactor=Contactor(open_at_first=True)))


def operate(served: Simulated, inst_reference: str) -> None:
    with served.client() as client:
        client.operate(served.reference(inst_reference), value=True)


def table(content: str) -> list[dict[str, str]]:
    """Rows of a Compressed ASCII report by label; a wrong checksum raises."""
    written = content.encode("ascii")
    lines = list(rows(Path("report"), written, 0, len(written), Repairs(lenient=False)))
    labels = lines[2].fields
    return [dict(zip(labels, line.fields, strict=True)) for line in lines[3:]]


def test_a_motor_that_the_scenario_stops_stands_from_then_on(tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed1")
    plant = replace(scenario.plant, contactor=Contactor(opens_s=0.5))
    with simulated(tmp_path / "relay", replace(scenario, plant=plant)) as served, served.client() as client:
        wait_until(lambda: served.relay._word["STOPPED"], "the motor to stop")
        changes = {(each["ELEMENT"], each["STATE"]) for each in table(text(client, "REPORTS/CSER.TXT"))}
        assert {("RUNNING", "Deasserted"), ("STOPPED", "Asserted")} <= changes
        operate(served, "CON/RBGGIO1.SPCSO03")
        assert served.relay._word["STARTING"], "it can be started again"


def test_a_start_is_recorded_from_rest_and_told_in_every_report(tmp_path: Path) -> None:
    scenario = stopped(scenario_of("sel-710-ed1"))
    scenario = replace(scenario, triggers=Triggers(motor_start=True))
    with simulated(tmp_path / "relay", scenario) as served, served.client() as client:
        assert table(text(client, "REPORTS/CHISTORY.TXT")) == []
        assert "History Buffer Empty" in text(client, "REPORTS/HISTORY.TXT")
        assert "No Motor Start Data" in text(client, "REPORTS/MSR.TXT")
        operate(served, "CON/RBGGIO1.SPCSO03")
        wait_until(lambda: bool(table(text(client, "REPORTS/CHISTORY.TXT"))), "the record in the history")
        wait_until(lambda: served.relay._word["RUNNING"], "the start to end")

        (row,) = table(text(client, "REPORTS/CHISTORY.TXT"))
        assert (row["REF_NUM"], row["EVENT"]) == ("10000", "ER MOTOR START")
        assert float(row["CURRENT"]) > 4 * 1.203
        assert "ER MOTOR START" in text(client, "REPORTS/HISTORY.TXT")

        changes = {(each["ELEMENT"], each["STATE"]) for each in table(text(client, "REPORTS/CSER.TXT"))}
        assert {("RB03", "Asserted"), ("STARTING", "Asserted"), ("STARTING", "Deasserted")} <= changes
        assert ("RUNNING", "Asserted") in changes
        assert "RUNNING" in text(client, "REPORTS/SER.TXT")

        report = text(client, "REPORTS/MSR.TXT")
        peak = re.search(r"Maximum start current +([\d.]+) A", report)
        assert peak is not None
        assert 5 * 1.203 < float(peak[1]) < 12 * 1.203
        assert re.search(r"Start time +0\.\d+ s", report)
        statistics = text(client, "REPORTS/MOT.TXT")
        assert re.search(r"Number of starts +1\r", statistics)
        highest = re.search(r"Peak running current +([\d.]+) A", statistics)
        assert highest is not None
        assert float(highest[1]) < 2 * 1.203 < float(peak[1]), "a start's current is not one of running"

        texts = {name: text(client, f"REPORTS/{name}.TXT") for name in ("SER", "CSER", "MSR", "MOT")}
        found = recordings(fetch(client, "EVENTS", tmp_path / "fetched"))
    (start,) = read_motor_starts(texts["MSR"])
    assert start.peak_current_A == pytest.approx(float(peak[1]))
    assert start.curve_current_A.max() == pytest.approx(float(peak[1]))
    assert read_motor_statistics(texts["MOT"]).starts == 1
    for name in ("SER", "CSER"):
        told = [each for each in read_sequence_of_events(texts[name]) if each.element == "STARTING"]
        assert [each.asserted for each in told[-2:]] == [True, False]
        assert abs(told[-2].time_ns - start.time_ns) < 1e8
    for recording in found:
        at = recording.trigger_index or 0
        noise = 0.02
        assert np.abs(recording.samples[:3, : at - 1]).max() < noise
        assert np.abs(recording.samples[:3, at:]).max() > 5
        assert recording.digitals is not None
        assert not recording.digitals.state("STARTING")[: at - 8].any()
        assert recording.digitals.state("STARTING")[-1]


def test_the_load_profile_has_what_was_metered(tmp_path: Path) -> None:
    scenario = replace(scenario_of("sel-710-ed2"), load_profile_s=1.0)
    with simulated(tmp_path, scenario) as served, served.client() as client:
        wait_until(lambda: len(table(text(client, "REPORTS/CLDP.TXT"))) >= 2, "two rows")
        for row in table(text(client, "REPORTS/CLDP.TXT")):
            assert float(row["IB_MAG"]) == pytest.approx(1.203, rel=0.02)
            assert float(row["VAVE"]) == pytest.approx(380, rel=0.01)
            assert float(row["P"]) == pytest.approx(436, rel=0.03)
            assert float(row["FREQ"]) == pytest.approx(50, abs=0.01)
        plain = read_load_profile(text(client, "REPORTS/LDP.TXT"))
        compressed = read_load_profile(text(client, "REPORTS/CLDP.TXT"))
    assert plain.values["IB_MAG"][0] == pytest.approx(1.203, rel=0.02)
    rows = plain.time_ns.size
    assert rows >= 2
    assert compressed.time_ns[:rows].tolist() == plain.time_ns.tolist()
    for label, column in plain.values.items():
        assert compressed.values[label][:rows].tolist() == column.tolist()


def test_a_listing_has_the_texts_at_their_size_and_settings_are_offered(tmp_path: Path) -> None:
    with simulated(tmp_path / "relay", scenario_of("sel-710-ed2")) as served, served.client() as client:
        assert [name.removeprefix("REPORTS/") for name in names(client, "REPORTS")] == sorted(
            f"{name}.TXT" for name in ("HISTORY", "CHISTORY", "SER", "CSER", "LDP", "CLDP", "MSR", "MOT")
        )
        sizes = {entry.name: entry.size for entry in client.files("REPORTS")}
        assert len(text(client, "REPORTS/SER.TXT")) == sizes["REPORTS/SER.TXT"]
        settings = text(client, "SETTINGS/SET_ALL.TXT")
        assert 'FLA,"1.74"' in settings
        assert 'E49MOTOR,"N"' in settings


@pytest.mark.parametrize(
    ("element", "protection", "kind"),
    [
        ("50P1T", ProtectionSettings(overcurrent=DefiniteTime(0.5, 0.2)), "PHASE 50 TRIP"),
        ("46UBT", ProtectionSettings(unbalance=DefiniteTime(0.05, 0.1)), "UNBALANCE TRIP"),
        ("49T", ProtectionSettings(thermal=ThermalOverload(1.0, 1.0)), "THERMAL TRIP"),
    ],
)
def test_a_trip_stops_the_motor_and_makes_a_record(
    element: str, protection: ProtectionSettings, kind: str, tmp_path: Path
) -> None:
    scenario = scenario_of("sel-710-ed2")
    supply = replace(scenario.plant.supply, unbalance=0.04)
    load = replace(scenario.plant.load, level=1.4)
    plant = replace(scenario.plant, supply=supply, load=load)
    scenario = replace(scenario, plant=plant, protection=protection)
    with simulated(tmp_path / "relay", scenario) as served, served.client() as client:
        wait_until(lambda: bool(table(text(client, "REPORTS/CHISTORY.TXT"))), "a trip")
        (row,) = table(text(client, "REPORTS/CHISTORY.TXT"))
        assert (row["EVENT"], row["TARGETS"]) == (kind, element)
        assert re.search(r"Trips, .* 1\r", text(client, "REPORTS/MOT.TXT"))
        (recording,) = recordings(fetch(client, "EVENTS", tmp_path / "fetched"))
    at = recording.trigger_index or 0
    assert np.abs(recording.samples[:3, :at]).max() > 1.5
    opening = round(0.04 * recording.sample_rate_hz)
    assert np.abs(recording.samples[:3, at : at + opening - 2]).max() > 1.5, "until the contactor has opened"
    assert np.abs(recording.samples[:3, at + opening + 2 :]).max() < 0.1
    assert recording.digitals is not None
    assert recording.digitals.state("TRIP")[at + 1 :].all()


def test_a_pulse_bit_pulses_its_remote_bit(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served, served.client() as client:
        client.operate(f"{IED}CON/PRBGGIO1.SPCSO02", value=True)
        wait_until(lambda: "RB02 Deasserted" in ser(client), "the end of the pulse")
        client.operate(f"{IED}CON/RBGGIO1.SPCSO05", value=True)
        client.operate(f"{IED}CON/PRBGGIO1.SPCSO05", value=True)
        pulsed = f"{IED}CON/PRBGGIO1.SPCSO05.stVal"
        wait_until(lambda: client.read(pulsed, FunctionalConstraint.ST) is False, "the end of the pulse")
        assert "RB05 Asserted" in ser(client)
        assert "RB05 Deasserted" not in ser(client), "the remote bit itself is still set"


def ser(client: Client) -> str:
    """The sequential events, bit and state one blank apart."""
    return re.sub(r" +", " ", text(client, "REPORTS/SER.TXT"))


def test_a_load_above_its_level_makes_a_record_once(tmp_path: Path) -> None:
    scenario = replace(scenario_of("sel-710-ed2"), triggers=Triggers(load_above=0.6))
    with simulated(tmp_path, scenario) as served, served.client() as client:
        wait_until(lambda: bool(table(text(client, "REPORTS/CHISTORY.TXT"))), "the load to be noticed")
        served.relay.update(served.relay._clock.now_ns())
        (row,) = table(text(client, "REPORTS/CHISTORY.TXT"))
        assert row["EVENT"] == "ER LOAD"
