"""Three files written here in the shapes that relay makers' tools give theirs, one of each edition.

EDITION_1: a CID without version attributes, with a maker's own elements and attributes everywhere.
EDITION_2: an IID with setting groups, a log and a disturbance recorder. EDITION_2_1: the IID of a merging
              unit
with sampled values, arrays, an ldName and a second access point.
"""

NAMESPACE = 'xmlns="http://www.iec.ch/61850/2003/SCL"'

_COMMON_TYPES = """
    <DOType id="ENS" cdc="ENS"><DA name="stVal" bType="Enum" type="Mode" fc="ST" dchg="true"/>
      <DA name="q" bType="Quality" fc="ST" qchg="true"/><DA name="t" bType="Timestamp" fc="ST"/></DOType>
    <DOType id="SPS" cdc="SPS"><DA name="stVal" bType="BOOLEAN" fc="ST" dchg="true"/>
      <DA name="q" bType="Quality" fc="ST" qchg="true"/><DA name="t" bType="Timestamp" fc="ST"/>
      <DA name="dU" bType="Unicode255" fc="DC"/></DOType>
    <DOType id="SPC" cdc="SPC"><DA name="Oper" bType="Struct" type="Oper" fc="CO"/>
      <DA name="stVal" bType="BOOLEAN" fc="ST" dchg="true"/><DA name="q" bType="Quality" fc="ST" qchg="true"/>
      <DA name="t" bType="Timestamp" fc="ST"/>
      <DA name="ctlModel" bType="Enum" type="CtlModel" fc="CF"><Val>direct-with-normal-security</Val></DA>
    </DOType>
    <DOType id="CMV" cdc="CMV"><DA name="instCVal" bType="Struct" type="Vector" fc="MX"/>
      <DA name="cVal" bType="Struct" type="Vector" fc="MX" dchg="true"/>
      <DA name="q" bType="Quality" fc="MX" qchg="true"/><DA name="t" bType="Timestamp" fc="MX"/></DOType>
    <DOType id="WYE" cdc="WYE"><SDO name="phsA" type="CMV"/><SDO name="phsB" type="CMV"/>
      <SDO name="phsC" type="CMV"/></DOType>
    <DOType id="LPL" cdc="LPL"><DA name="vendor" bType="VisString255" fc="DC"/>
      <DA name="swRev" bType="VisString255" fc="DC"/></DOType>
    <DAType id="Analogue"><BDA name="f" bType="FLOAT32"/></DAType>
    <DAType id="Vector"><BDA name="mag" bType="Struct" type="Analogue"/>
      <BDA name="ang" bType="Struct" type="Analogue"/></DAType>
    <DAType id="Originator"><BDA name="orCat" bType="Enum" type="Category"/>
      <BDA name="orIdent" bType="Octet64"/></DAType>
    <DAType id="Oper"><BDA name="ctlVal" bType="BOOLEAN"/>
      <BDA name="origin" bType="Struct" type="Originator"/><BDA name="ctlNum" bType="INT8U"/>
      <BDA name="T" bType="Timestamp"/><BDA name="Test" bType="BOOLEAN"/><BDA name="Check" bType="Check"/>
    </DAType>"""

_ENUMERATIONS = """
    <EnumType id="Mode"><EnumVal ord="1">on</EnumVal><EnumVal ord="5">off</EnumVal></EnumType>
    <EnumType id="CtlModel"><EnumVal ord="0">status-only</EnumVal>
      <EnumVal ord="1">direct-with-normal-security</EnumVal></EnumType>
    <EnumType id="Category"><EnumVal ord="0">not-supported</EnumVal></EnumType>"""

EDITION_1 = f"""<?xml version="1.0" encoding="utf-8"?>
<SCL xmlns:maker="urn:maker" {NAMESPACE}>
  <Header id="Project" version="0" revision="1.0" toolID="Tool" nameStructure="IEDName"><History>
    <Hitem version="0" revision="1.0" when="08/11/2024 22:54:47" who="A" what="CID"/></History></Header>
  <Communication><SubNetwork name="W01"><ConnectedAP iedName="FEEDER_1" apName="S1"><Address>
      <P type="IP">192.168.1.52</P><P type="IP-SUBNET">255.255.255.0</P><P type="OSI-TSEL">0001</P></Address>
    <GSE ldInst="CFG" cbName="TRIP"><Address><P type="MAC-Address">01-0C-CD-01-00-03</P>
      <P type="APPID">0003</P><P type="VLAN-PRIORITY">4</P><P type="VLAN-ID">001</P></Address>
      <MinTime unit="s" multiplier="m">4</MinTime><MaxTime unit="s" multiplier="m">1000</MaxTime></GSE>
  </ConnectedAP></SubNetwork></Communication>
  <IED name="FEEDER_1" desc="Feeder relay" type="R_751" manufacturer="M" configVersion="ICD-R102">
    <Private type="M_IedInfo"><maker:ModelNumber>R-751</maker:ModelNumber><maker:IED name="other"/></Private>
    <Services><DynAssociation/><GetDirectory/><ConfDataSet max="16" maxAttributes="120"/><FileHandling/>
    </Services>
    <AccessPoint name="S1"><Server><Authentication/>
      <LDevice inst="CFG" desc="Configuration">
        <LN0 lnClass="LLN0" inst="" lnType="LN0">
          <DataSet name="DSet01"><FCDA ldInst="PRO" prefix="TRIP" lnClass="PTRC" lnInst="1" doName="Tr"
              fc="ST"/>
            <FCDA ldInst="MET" prefix="MET" lnClass="MMXU" lnInst="1" doName="A.phsA" daName="cVal" fc="MX"/>
          </DataSet>
          <ReportControl name="BRep01" datSet="DSet01" rptID="DSet01" confRev="1" buffered="true"
              bufTime="500">
            <TrgOps dchg="true" qchg="true"/><OptFields seqNum="true"/><RptEnabled/></ReportControl>
          <ReportControl name="URep" datSet="DSet01" rptID="U" confRev="1"><OptFields/><RptEnabled max="3"/>
          </ReportControl>
          <DOI name="NamPlt" maker:datasrc="imm"><DAI name="vendor"
              maker:datasrc="imm"><Val>M</Val></DAI></DOI>
          <GSEControl name="TRIP" datSet="DSet01" confRev="1" appID="FEEDER_1" maker:label="x"/>
        </LN0></LDevice>
      <LDevice inst="PRO"><LN0 lnClass="LLN0" inst="" lnType="LN0"/>
        <LN prefix="TRIP" lnClass="PTRC" inst="1" lnType="PTRC"/></LDevice>
      <LDevice inst="MET"><LN0 lnClass="LLN0" inst="" lnType="LN0"/>
        <LN prefix="MET" lnClass="MMXU" inst="1" lnType="MMXU"/></LDevice>
      <LDevice inst="CON"><LN0 lnClass="LLN0" inst="" lnType="LN0"/>
        <LN prefix="RB" lnClass="GGIO" inst="1" lnType="RBGGIO"><Private type="M_Note">RB01</Private></LN>
      </LDevice>
    </Server></AccessPoint>
  </IED>
  <DataTypeTemplates>
    <LNodeType id="LN0" lnClass="LLN0"><DO name="Mod" type="ENS"/><DO name="NamPlt" type="LPL"/></LNodeType>
    <LNodeType id="PTRC" lnClass="PTRC"><DO name="Mod" type="ENS"/><DO name="Tr" type="SPS"/></LNodeType>
    <LNodeType id="MMXU" lnClass="MMXU"><DO name="A" type="WYE"/></LNodeType>
    <LNodeType id="RBGGIO" lnClass="GGIO"><DO name="SPCSO01" type="SPC"/><DO name="SPCSO02" type="SPC"/>
    </LNodeType>{_COMMON_TYPES}{_ENUMERATIONS}
  </DataTypeTemplates>
</SCL>
"""

EDITION_2 = f"""<?xml version="1.0" encoding="UTF-8"?>
<SCL xmlns:maker="urn:maker" version="2007" revision="B" {NAMESPACE}>
  <Header id="vied" version="24" revision="1.0" toolID="Tool"/>
  <IED name="RELAY_2" type="R_751" manufacturer="M" configVersion="ICD-R401" originalSclVersion="2007"
       originalSclRevision="B">
    <Services nameLength="32"><ReportSettings owner="true" resvTms="true"/><FileHandling
              mms="true"/></Services>
    <AccessPoint name="S1"><Server><Authentication none="true"/>
      <LDevice inst="PRO">
        <LN0 lnClass="LLN0" inst="" lnType="LN0">
          <DataSet name="Events"><FCDA ldInst="PRO" prefix="FLT" lnClass="RDRE" lnInst="1" doName="RcdMade"
              fc="ST"/>
          </DataSet>
          <ReportControl name="Ev" datSet="Events" confRev="2" buffered="true" indexed="false">
            <TrgOps dchg="true" gi="false"/><OptFields entryID="true"/><RptEnabled max="1">
              <ClientLN iedName="SCADA" ldInst="LD0" lnClass="ITCI" lnInst="1" apRef="S1"/></RptEnabled>
          </ReportControl>
          <LogControl name="Sequence" datSet="Events" logName="GeneralLog"/><Log name="GeneralLog"/>
          <SettingControl maker:label="NUMGRP" numOfSGs="4" actSG="1"/>
        </LN0>
        <LN prefix="FLT" lnClass="RDRE" inst="1" lnType="RDRE"/>
        <LN lnClass="PIOC" inst="1" lnType="PIOC"><DOI name="StrVal"><SDI name="setMag"><DAI name="f">
          <Val sGroup="1">2.5</Val><Val sGroup="2">3.5</Val></DAI></SDI></DOI></LN>
      </LDevice>
    </Server></AccessPoint>
  </IED>
  <DataTypeTemplates>
    <LNodeType id="LN0" lnClass="LLN0"><DO name="Mod" type="ENS"/><DO name="NamPlt" type="LPL"/></LNodeType>
    <LNodeType id="RDRE" lnClass="RDRE"><DO name="RcdMade" type="SPS"/><DO name="FltNum" type="ENS"/>
      <DO name="RcdTrg" type="SPC" transient="true"/></LNodeType>
    <LNodeType id="PIOC" lnClass="PIOC"><DO name="StrVal" type="ASG"/><DO name="Blk" type="BLS"/></LNodeType>
    <DOType id="ASG" cdc="ASG"><DA name="setMag" bType="Struct" type="Analogue" fc="SE"/>
      <DA name="dataNs" bType="VisString255" fc="EX"/></DOType>
    <DOType id="BLS" cdc="SPS"><DA name="stVal" bType="BOOLEAN" fc="ST" dchg="true"/>
      <DA name="q" bType="Quality" fc="ST"/><DA name="blkEna" bType="BOOLEAN" fc="BL"/>
      <DA name="subEna" bType="BOOLEAN" fc="SV"/><DA name="opRcvd" bType="BOOLEAN" fc="OR"/>
      <DA name="tOpOk" bType="Timestamp" fc="OR"/><DA name="addr" bType="SvOptFlds" fc="SP"/>
      <DA name="source" bType="ObjRef" fc="SP"/><DA name="bits" bType="Octet16" fc="SP"/></DOType>
    {_COMMON_TYPES}{_ENUMERATIONS}
  </DataTypeTemplates>
</SCL>
"""

EDITION_2_1 = f"""<?xml version="1.0" encoding="UTF-8"?>
<SCL version="2007" revision="B" release="4" {NAMESPACE} xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:schemaLocation="http://www.iec.ch/61850/2003/SCL SCL.xsd"
     xmlns:e="http://www.iec.ch/61850/2019/SCL/6-100" e:version="2019">
  <Private type="Library-Version">V09.80</Private>
  <Header id="MU" version="1" revision="5"><Text>Iid-File</Text></Header>
  <Communication><SubNetwork name="Subnet" type="8-MMS"><Private type="Start">172.16.0.1</Private>
    <ConnectedAP iedName="MU" apName="E" redProt="prp"><Address>
      <P type="IP" xsi:type="tP_IP">10.102.76.51</P></Address>
      <SMV ldInst="MU01" cbName="MSVCB01"><Address><P type="MAC-Address">01-0C-CD-04-00-01</P>
        <P type="APPID">4001</P><P type="VLAN-ID">00A</P><P type="VLAN-PRIORITY">4</P></Address></SMV>
    </ConnectedAP></SubNetwork></Communication>
  <IED name="MU" type="S5" manufacturer="S" configVersion="5" originalSclVersion="2007"
              originalSclRevision="B"
       originalSclRelease="4" engRight="full" owner="MU">
    <AccessPoint name="E"><Private type="Id">1</Private><Server timeout="0"><Authentication none="true"/>
      <LDevice inst="MU01" ldName="Merging_1">
        <LN0 lnClass="LLN0" inst="" lnType="LN0">
          <Private type="GUID">7030046a</Private>
          <DataSet name="PhsMeas1">
            <FCDA ldInst="MU01" lnClass="MHAI" lnInst="1" doName="HA.har" daName="cVal.mag.f" ix="1" fc="MX"/>
            <FCDA ldInst="Q0" lnClass="RDRE" prefix="DEF_" lnInst="1" doName="RcdMade" daName="stVal"
              fc="ST"/>
          </DataSet>
          <ReportControl rptID="A" confRev="1" buffered="false" name="A_URCB"><Private type="P"/><OptFields/>
          </ReportControl>
          <GSEControl name="Status" appID="VMU"><Protocol
              mustUnderstand="true">R-GOOSE</Protocol></GSEControl>
          <SampledValueControl datSet="PhsMeas1" confRev="1" smvID="ST2" multicast="true" smpRate="80"
              nofASDU="1"
            smpMod="SmpPerPeriod" name="MSVCB01"><SmvOpts/></SampledValueControl>
          <SampledValueControl smvID="ST3" multicast="false" smpRate="4000" nofASDU="1" smpMod="SmpPerSec"
            name="USVCB01"><SmvOpts/></SampledValueControl>
        </LN0>
        <LN lnClass="MHAI" inst="1" lnType="MHAI"/>
      </LDevice>
      <LDevice inst="Q0"><LN0 lnClass="LLN0" inst="" lnType="LN0"/>
        <LN prefix="DEF_" lnClass="RDRE" inst="1" lnType="RDRE" e:kind="x"/></LDevice>
    </Server></AccessPoint>
    <AccessPoint name="F"><ServerAt apName="E"/></AccessPoint>
  </IED>
  <DataTypeTemplates>
    <LNodeType id="LN0" lnClass="LLN0"><DO name="Mod" type="ENS"/></LNodeType>
    <LNodeType id="MHAI" lnClass="MHAI"><DO name="HA" type="HMV"/><DO name="Curve" type="CSD"/></LNodeType>
    <LNodeType id="RDRE" lnClass="RDRE"><DO name="RcdMade" type="SPS"/></LNodeType>
    <LNodeType id="RDRE" lnClass="GGIO"><DO name="Ind" type="SPS"/></LNodeType>
    <DOType id="HMV" cdc="HMV"><SDO name="har" type="CMV" count="3"/>
      <DA name="q" bType="Quality" fc="MX"/><DA name="numHar" bType="INT16U"
              fc="CF"><Val>3</Val></DA></DOType>
    <DOType id="CSD" cdc="CSD"><DA name="crvPts" bType="Struct" type="Point" count="4" fc="DC"/>
      <DA name="maxPts" bType="INT16U" fc="CF"/><DA name="weights" bType="FLOAT32" count="2"
              fc="CF"/></DOType>
    {_COMMON_TYPES}
    <DAType id="Point"><BDA name="xVal" bType="FLOAT32"/><BDA name="yVal" bType="Struct"
              type="Analogue"/></DAType>
    {_ENUMERATIONS}
  </DataTypeTemplates>
</SCL>
"""

SHAPES = {"edition-1.cid": EDITION_1, "edition-2.iid": EDITION_2, "edition-2.1.iid": EDITION_2_1}
