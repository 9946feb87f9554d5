"""Small SCL documents for tests: one relay whose parts a test can replace."""

from pathlib import Path

import scl

NAMESPACE = "http://www.iec.ch/61850/2003/SCL"

TEMPLATES = """
  <LNodeType id="LLN0" lnClass="LLN0"><DO name="Mod" type="Mod"/></LNodeType>
  <LNodeType id="GGIO" lnClass="GGIO"><DO name="Ind1" type="SPS"/><DO name="AnIn1" type="MV"/></LNodeType>
  <DOType id="Mod" cdc="ENC">
    <DA name="stVal" bType="Enum" type="Mode" fc="ST" dchg="true"/>
    <DA name="ctlModel" bType="Enum" type="CtlModel" fc="CF"><Val>status-only</Val></DA>
  </DOType>
  <DOType id="SPS" cdc="SPS">
    <DA name="stVal" bType="BOOLEAN" fc="ST" dchg="true"/>
    <DA name="q" bType="Quality" fc="ST" qchg="true"/>
    <DA name="d" bType="VisString255" fc="DC"><Val>from the type</Val></DA>
  </DOType>
  <DOType id="MV" cdc="MV">
    <DA name="mag" bType="Struct" type="AnalogueValue" fc="MX" dchg="true"/>
    <DA name="units" bType="Struct" type="Unit" fc="CF"/>
  </DOType>
  <DAType id="AnalogueValue"><BDA name="f" bType="FLOAT32"/></DAType>
  <DAType id="Unit"><BDA name="SIUnit" bType="Enum" type="SIUnit"><Val>A</Val></BDA></DAType>
  <EnumType id="Mode"><EnumVal ord="1">on</EnumVal><EnumVal ord="5">off</EnumVal></EnumType>
  <EnumType id="CtlModel"><EnumVal ord="0">status-only</EnumVal></EnumType>
  <EnumType id="SIUnit"><EnumVal ord="5">A</EnumVal><EnumVal ord="29">V</EnumVal></EnumType>
"""

MEMBER = '<FCDA lnClass="GGIO" lnInst="1" doName="Ind1" fc="ST"/>'
NODE_ZERO = '<LN0 lnClass="LLN0" inst="" lnType="LLN0"/>'
NODES = '<LN lnClass="GGIO" inst="1" lnType="GGIO"/>'

COMMUNICATION = """
  <Communication><SubNetwork name="Net" type="8-MMS"><ConnectedAP iedName="R1" apName="S1"><Address>
    <P type="IP">10.0.0.7</P>
  </Address></ConnectedAP></SubNetwork></Communication>
"""


def scl_text(
    *,
    node_zero: str = NODE_ZERO,
    nodes: str = NODES,
    templates: str = TEMPLATES,
    communication: str = COMMUNICATION,
    substation: str = "",
    services: str = "",
    root: str = f'xmlns="{NAMESPACE}" version="2007" revision="B"',
    header: str = '<Header id="test"/>',
    device: str = 'inst="LD0"',
) -> str:
    """An SCL document with one relay R1 and one logical device."""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<SCL {root}>
  {header}{substation}{communication}
  <IED name="R1">{services}
    <AccessPoint name="S1"><Server><Authentication/>
      <LDevice {device}>{node_zero}{nodes}</LDevice>
    </Server></AccessPoint>
  </IED>
  <DataTypeTemplates>{templates}</DataTypeTemplates>
</SCL>
"""


def write_scl(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def read(tmp_path: Path, **parts: str) -> scl.Scl:
    return scl.read(write_scl(tmp_path / "relay.cid", scl_text(**parts)))


def messages(read_scl: scl.Scl) -> str:
    return "\n".join(map(str, read_scl.warnings))
