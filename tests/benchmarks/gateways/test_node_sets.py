"""What of our OPC UA types differs from published node sets is told."""

import asyncio
from dataclasses import replace
from pathlib import Path

from benchmarks.gateways.node_sets import Described, differences, ours, published
from service.gateways.opcua.namespaces import DEVICES, MACHINERY, STANDARD

FOLDER_TYPE = (STANDARD, 61)
MONITORING = (MACHINERY, 1014)
NODE_SET = """<?xml version="1.0"?>
<UANodeSet xmlns="http://opcfoundation.org/UA/2011/03/UANodeSet.xsd">
  <NamespaceUris><Uri>http://opcfoundation.org/UA/Machinery/</Uri><Uri>http://opcfoundation.org/UA/DI/</Uri></NamespaceUris>
  <Aliases><Alias Alias="HasSubtype">i=45</Alias><Alias Alias="String">i=12</Alias></Aliases>
  <UAObjectType NodeId="ns=1;i=1014" BrowseName="1:MonitoringType">
    <References><Reference ReferenceType="HasSubtype" IsForward="false">i=61</Reference></References>
  </UAObjectType>
  <UAVariable NodeId="ns=1;i=6003" BrowseName="2:SerialNumber" DataType="String"><References/></UAVariable>
</UANodeSet>
"""


def test_a_node_set_is_read(tmp_path: Path) -> None:
    path = tmp_path / "set.xml"
    path.write_text(NODE_SET)
    assert published(path) == {
        MONITORING: Described(
            "ObjectType",
            (MACHINERY, "MonitoringType"),
            None,
            is_abstract=False,
            references=frozenset({(45, False, FOLDER_TYPE)}),
        ),
        (MACHINERY, 6003): Described(
            "Variable", (DEVICES, "SerialNumber"), (STANDARD, 12), is_abstract=False, references=frozenset()
        ),
    }


def test_each_difference_is_told() -> None:
    own = asyncio.run(ours())
    assert list(differences(own, own)) == []
    known = own[MONITORING]
    others = {
        "is in no node set": {node: one for node, one in own.items() if node != MONITORING},
        "name is": {**own, MONITORING: replace(known, name=(MACHINERY, "Watching"))},
        "is_abstract is": {**own, MONITORING: replace(known, is_abstract=True)},
        "node_class is": {**own, MONITORING: replace(known, node_class="Object")},
        "reference 46": {
            **own,
            MONITORING: replace(known, references=frozenset()),
            (MACHINERY, 6089): replace(own[MACHINERY, 6089], references=frozenset()),
        },
    }
    for expected, sets in others.items():
        assert [line for line in differences(own, sets) if expected in line], expected
