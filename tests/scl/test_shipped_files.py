"""The relay's ICD and the demo plant's SCD: what the simulator serves and the service looks for."""

from pathlib import Path

import pytest

import scl
from scl import Address, Scl
from scl.control_block_model import OptionalFields
from scl.data_model import DataAttribute, FunctionalConstraint, TriggerOptions
from scl.demo_plant import write_demo_plant
from testing.scl_schema import schema_errors

RELAYS = {
    "PUMP-A1": ("FACTORY_A", "A1_SEL710", 10210),
    "FAN-A2": ("FACTORY_A", "A2_SEL710", 10211),
    "MILL-A3": ("FACTORY_A", "A3_SEL710", 10212),
    "CONVEYOR-B1": ("FACTORY_B", "B1_SEL710", 10213),
    "COMPRESSOR-B2": ("FACTORY_B", "B2_SEL710", 10214),
    "PUMP-B3": ("FACTORY_B", "B3_SEL710", 10215),
}


@pytest.fixture(scope="module")
def plant() -> Scl:
    return scl.read(scl.DEMO_PLANT_SCD)


@pytest.mark.parametrize("path", [scl.SEL710_ICD, scl.DEMO_PLANT_SCD])
def test_read_without_a_warning_as_edition_2(path: Path) -> None:
    read = scl.read(path)
    assert read.warnings == ()
    assert read.header.edition == "2"


@pytest.mark.parametrize("path", [scl.SEL710_ICD, scl.DEMO_PLANT_SCD])
def test_the_schema_takes_them(path: Path) -> None:
    assert schema_errors(path) == []


def test_the_schema_refuses_what_it_does_not_know(tmp_path: Path) -> None:
    text = scl.SEL710_ICD.read_text(encoding="utf-8")
    file = tmp_path / "relay.icd"
    file.write_text(
        text.replace('<IED name="TEMPLATE"', '<IED title="relay" name="TEMPLATE"'), encoding="utf-8"
    )
    (error,) = schema_errors(file)
    assert "The attribute 'title' is not allowed" in error


def test_committed_plant_is_what_its_table_and_the_icd_make(tmp_path: Path) -> None:
    write_demo_plant(tmp_path / "plant.scd")
    assert (tmp_path / "plant.scd").read_bytes() == scl.DEMO_PLANT_SCD.read_bytes()


def test_each_motor_has_its_site_relay_and_address(plant: Scl) -> None:
    feeders = {feeder.motor: feeder for feeder in plant.feeders()}
    assert {name: (f.site, f.ied, plant.address(f.ied).port) for name, f in feeders.items()} == RELAYS
    assert {plant.address(feeder.ied).host for feeder in feeders.values()} == {"127.0.0.1"}
    assert feeders["MILL-A3"].site_description == "Factory A"
    assert feeders["MILL-A3"].motor_description == "Ball mill, 37 kW 400 V 50 Hz"
    assert feeders["MILL-A3"].bay == "A3"


def test_trigger_is_a_direct_control_with_a_full_oper_structure(plant: Scl) -> None:
    controls = plant.ied("B1_SEL710").data_objects(ln_class="GGIO", common_data_class="SPC")
    assert [control.reference for control in controls] == [
        *(f"B1_SEL710CON/RBGGIO1.SPCSO{number:02d}" for number in range(1, 33)),
        *(f"B1_SEL710CON/PRBGGIO1.SPCSO{number:02d}" for number in range(1, 9)),
    ]
    trigger = controls[0].data_object
    assert trigger.control_model == "direct-with-normal-security"
    oper = trigger.find("Oper")
    assert isinstance(oper, DataAttribute)
    assert [(part.name, part.fc) for part in oper.attributes] == [
        (name, FunctionalConstraint.CO) for name in ("ctlVal", "origin", "ctlNum", "T", "Test", "Check")
    ]


def test_events_reach_a_client_by_a_buffered_report(plant: Scl) -> None:
    ied = plant.ied("A1_SEL710")
    (record_made,) = ied.data_objects(ln_class="RDRE", name="RcdMade")
    report = ied.report_controls(buffered=True, covering=record_made.reference)[0]
    assert report.references == ("A1_SEL710CFG/LLN0.BR.BRep01",)
    assert report.trigger_options == (
        TriggerOptions.DATA_CHANGE
        | TriggerOptions.QUALITY_CHANGE
        | TriggerOptions.INTEGRITY
        | TriggerOptions.GENERAL_INTERROGATION
    )
    assert report.optional_fields == ~OptionalFields.DATA_REFERENCE
    assert report.data_set is not None
    assert [member.reference for member in report.data_set.members] == [
        "A1_SEL710PRO/FLTRDRE1.RcdMade",
        "A1_SEL710PRO/FLTRDRE1.FltNum",
        "A1_SEL710PRO/TRIPPTRC1.Tr",
        "A1_SEL710CON/RBGGIO1.SPCSO01",
    ]
    assert {member.fc for member in report.data_set.members} == {FunctionalConstraint.ST}


def test_metering_is_found_by_what_it_covers(plant: Scl) -> None:
    ied = plant.ied("A1_SEL710")
    (metering,) = ied.data_sets(covering="A1_SEL710MET/METMMXU1.A.phsA.cVal.mag.f")
    assert metering.reference == "A1_SEL710CFG/LLN0.DSet02"
    assert [
        report.instances
        for report in ied.report_controls(buffered=False, covering=metering.members[0].reference)
    ]
    for path in ("A.phsC.cVal.mag.f", "PPV.phsAB.cVal.ang.f", "Hz.mag.f", "TotPF.instMag.f"):
        attribute = ied.find(f"MET/METMMXU1.{path}")
        assert isinstance(attribute, DataAttribute)
        assert (attribute.fc, attribute.basic_type) == (FunctionalConstraint.MX, "FLOAT32")
    units = ied.find("A1_SEL710MET/METMMXU1.TotPF.units.SIUnit")
    assert isinstance(units, DataAttribute)
    assert (units.value, units.ordinal) == ("cos(phi)", 65)


def test_a_data_object_can_carry_an_instance_value(plant: Scl) -> None:
    description = plant.ied("A1_SEL710").find("CON/RBGGIO1.SPCSO32.d")
    assert isinstance(description, DataAttribute)
    assert description.value == "RB32"


def test_every_relay_has_the_icd_s_data_model(plant: Scl) -> None:
    (template,) = scl.read(scl.SEL710_ICD).ieds
    wanted = [[node.data_objects for node in device.logical_nodes] for device in template.logical_devices]
    for ied in plant.ieds:
        assert [
            [node.data_objects for node in device.logical_nodes] for device in ied.logical_devices
        ] == wanted


def test_unknown_relay_names_those_there_are(plant: Scl) -> None:
    with pytest.raises(scl.SclError, match=r"demo_plant\.scd: .*C9_SEL710.*A1_SEL710"):
        plant.ied("C9_SEL710")
    assert Address("10.0.0.1").port == 102
