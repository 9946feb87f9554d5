"""The files that describe the IED say what it is, and other readers understand them."""

import hashlib
import json
from pathlib import Path

import pytest
from lxml import etree
from open61850 import scl as open_scl
from scl_loader import SCD_handler

import scl
from mms import Client, FunctionalConstraint
from service.gateways.iec61850.description import NAMESPACE, TEMPLATE, description
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.relays.pki import Pki
from testing.scl_schema import schema_errors
from testing.service.gateways import running_gateways
from tests.service.gateways.iec61850.test_iec61850 import FAN, PUMP, port
from tests.service.gateways.settings import settings_of
from tests.service.gateways.tls import files_of

__all__ = ["port"]  # a fixture

TAGS = {"scl": NAMESPACE}
MEMBERS_OF_REVISION = ("3", "c27856279d043afa")
"""confRev, and the digest of what reports of that revision have. Clients notice a change by confRev alone."""


def members_and_layouts(root: etree._Element) -> str:
    """What a report has: the members of the data sets in their order, and the attributes of each type."""
    sets = {
        device.get("inst"): [
            [one.get(name) for name in ("prefix", "lnClass", "lnInst", "doName", "daName", "fc")]
            for one in device.iterfind(".//scl:DataSet/scl:FCDA", TAGS)
        ]
        for device in root.iterfind(".//scl:LDevice", TAGS)
    }
    types = {
        kind.get("id"): [sorted(one.attrib.items()) for one in kind]
        for kind in root.iterfind("scl:DataTypeTemplates/*", TAGS)
    }
    return json.dumps([sets, types], sort_keys=True)


def test_data_sets_with_other_members_have_another_revision() -> None:
    content = description("MCC", {"PUMP": "Pump"}, plant="PLANT", revision="1.0", shown={})
    root = etree.fromstring(content)
    digest = hashlib.sha256(members_and_layouts(root).encode()).hexdigest()[:16]
    (revision,) = {one.get("confRev") for one in root.iterfind(".//scl:ReportControl", TAGS)}
    assert (revision, digest) == MEMBERS_OF_REVISION, (
        "the data sets have changed: count CONFIGURATION_REVISION up, and write down both here"
    )


def test_the_server_tells_the_revision_of_the_file(port: int, tmp_path: Path) -> None:
    root = etree.parse(tmp_path / "statorwatch.iid")
    revisions = {one.get("confRev") for one in root.iterfind(".//scl:ReportControl", TAGS)}
    with Client.connect(LOOPBACK, port) as client:
        name_plate = client.read(f"{PUMP}/LLN0.NamPlt.configRev", FunctionalConstraint.DC)
        block = client.read(f"{PUMP}/LLN0.brcbVerdict01.ConfRev", FunctionalConstraint.BR)
    assert revisions == {name_plate} == {str(block)}


def test_the_instance_is_read_by_ours_and_by_another_reader(port: int, tmp_path: Path) -> None:
    file = tmp_path / "statorwatch.iid"
    ours = scl.read(file)
    assert ours.warnings == ()
    assert {device.name for device in ours.ied("MCC").logical_devices} == {PUMP, FAN, "MCCPLANT"}
    (theirs,) = open_scl.load_ieds(file)
    assert set(theirs.domains) == {PUMP, FAN, "MCCPLANT"}


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # it leaves the file open
@pytest.mark.parametrize("kind", ["iid", "icd"])
def test_the_schema_and_its_reader_take_the_files(port: int, tmp_path: Path, kind: str) -> None:
    file = tmp_path / f"statorwatch.{kind}"
    assert schema_errors(file) == []
    (ied,) = SCD_handler(str(file)).get_all_IEDs()
    (access_point,) = ied.get_children("AccessPoint")
    devices = {f"MCC{device.inst}": device for device in ied.get_children_LDs(access_point.name)}
    assert set(devices) == {PUMP, FAN, "MCCPLANT"}
    health = devices[PUMP].get_LN_by_name("ZMOT1").EEHealth
    assert {leaf.rpartition(".")[2] for leaf in health.get_DA_leaf_nodes()} >= {"stVal", "q", "t"}


def test_what_can_be_had_is_the_same_under_no_name_of_its_own(port: int, tmp_path: Path) -> None:
    instance, capabilities = (tmp_path / f"statorwatch.{kind}" for kind in ("iid", "icd"))
    assert scl.read(capabilities).warnings == ()
    (theirs,) = open_scl.load_ieds(capabilities)
    assert theirs.name == TEMPLATE == "TEMPLATE"
    named = instance.read_text(encoding="utf-8")
    assert capabilities.read_text(encoding="utf-8") == named.replace(
        '<IED name="MCC"', '<IED name="TEMPLATE"'
    )


@pytest.mark.parametrize("guards", [(), ("password",), ("certificate",), ("password", "certificate")])
def test_the_file_says_what_clients_have_to_show(
    repository: Repository, tmp_path: Path, guards: tuple[str, ...]
) -> None:
    table: dict[str, object] = {}
    if "password" in guards:
        secret = tmp_path / "password"
        secret.write_text("open sesame\n", encoding="ascii")
        secret.chmod(0o600)
        table["password_file"] = secret
    if "certificate" in guards:
        table["tls"] = files_of(Pki.make(tmp_path))
    with running_gateways(settings_of("iec61850", tmp_path, **table)):
        root = etree.parse(tmp_path / "statorwatch.iid")
    (found,) = root.iterfind(".//scl:Authentication", TAGS)
    expected = guards or ("none",)
    assert dict(found.attrib) == {
        way: str(way in expected).lower() for way in ("none", "password", "certificate")
    }
