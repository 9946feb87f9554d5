"""Make an Excel workbook whose tables are read from a service again with Data, Refresh All (Power Query).

python examples/make_excel_workbook.py http://127.0.0.1:8710 motors.xlsx

The workbook holds no token: its sheet "settings" has the path of a file with one.
"""

import base64
import io
import struct
import sys
import uuid
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr
from zipfile import ZIP_DEFLATED, ZipFile

import xlsxwriter

from service.exports import alarms, recordings, trends
from service.exports.tables import ColumnType, Table

TABLES: Mapping[str, Table[Any]] = {
    "Trend": trends.TABLE,
    "Recordings": recordings.TABLE,
    "Alarms": alarms.TABLE,
}
"""The query of each table; its sheet has the table's own name."""

SHEETS = "xl/worksheets"
RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
SHEET_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
XML = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
SCHEMAS = 'xmlns:xsd="http://www.w3.org/2001/XMLSchema" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'

QUERY = """shared {name} = let
    Address = Excel.CurrentWorkbook(){{[Name="Address"]}}[Content]{{0}}[Column1],
    TokenFile = Excel.CurrentWorkbook(){{[Name="TokenFile"]}}[Content]{{0}}[Column1],
    Headers = if TokenFile = null or TokenFile = "" then []
        else [Authorization = "Bearer " & Text.Trim(Text.FromBinary(File.Contents(TokenFile)))],
    Answer = Web.Contents(Address, [RelativePath = "api/v1/exports/{table}", Query = [format = "csv"],
        Headers = Headers, Timeout = #duration(0, 0, 10, 0)]),
    Rows = Csv.Document(Answer, [Delimiter = ",", Encoding = 65001, QuoteStyle = QuoteStyle.Csv]),
    Named = Table.PromoteHeaders(Rows, [PromoteAllScalars = true]),
    Known = Table.ReplaceValue(Named, "", null, Replacer.ReplaceValue, Table.ColumnNames(Named)),
    Timed = Table.TransformColumns(Known, {{{times}}}),
    Typed = Table.TransformColumnTypes(Timed, {{{numbers}}}, "en-US")
in
    Typed;
"""


def main() -> None:
    address, output = sys.argv[1:]
    Path(output).write_bytes(connected(plain_workbook(address.rstrip("/"))))
    print(f"{output}: open it in Excel, see its sheet settings, then Data, Refresh All")


def plain_workbook(address: str) -> bytes:
    """Return the workbook without its queries: settings, and an empty table for each of them."""
    file = io.BytesIO()
    with xlsxwriter.Workbook(file) as book:
        sheet = book.add_worksheet("settings")
        sheet.set_column(0, 1, 40)
        sheet.write_string("A1", "Address of the service")
        sheet.write_string("B1", address)
        sheet.write_string("A2", "File with a token (empty: none is asked for)")
        sheet.write_string("A4", "Then: Data, Refresh All. Times are UTC.")
        book.define_name("Address", "=settings!$B$1")
        book.define_name("TokenFile", "=settings!$B$2")
        dates = book.add_format({"num_format": "yyyy-mm-dd hh:mm:ss"})
        for name, table in TABLES.items():
            sheet = book.add_worksheet(table.name)
            sheet.set_column(0, len(table.columns) - 1, 16)
            for at, column in enumerate(table.columns):
                if column.type is ColumnType.TIME:
                    sheet.set_column(at, at, 20, dates)
            columns = [{"header": column.name} for column in table.columns]
            sheet.add_table(0, 0, 1, len(columns) - 1, {"name": name, "columns": columns})
    return file.getvalue()


def connected(workbook: bytes) -> bytes:
    """Return the workbook with a query behind each table."""
    with ZipFile(io.BytesIO(workbook)) as plain:
        parts = {name: plain.read(name) for name in plain.namelist()}
    overrides, relations = [], []
    for number, table in enumerate(TABLES.values(), start=1):
        part = f"xl/tables/table{number}.xml"
        parts[part] = parts[part].replace(b"<table ", b'<table tableType="queryTable" ', 1)
        for at in range(1, len(table.columns) + 1):
            field = f'<tableColumn id="{at}" uniqueName="{at}" queryTableFieldId="{at}" '
            parts[part] = parts[part].replace(f'<tableColumn id="{at}" '.encode(), field.encode(), 1)
        target = f"../queryTables/queryTable{number}.xml"
        parts[f"xl/tables/_rels/table{number}.xml.rels"] = _relationships([("queryTable", target)])
        parts[f"xl/queryTables/queryTable{number}.xml"] = _query_table(number, table)
        overrides.append((f"/xl/queryTables/queryTable{number}.xml", f"{SHEET_TYPE}.queryTable+xml"))
    parts["xl/connections.xml"] = _connections()
    overrides.append(("/xl/connections.xml", f"{SHEET_TYPE}.connections+xml"))
    parts["customXml/item1.xml"] = _mashup_part()
    parts["customXml/itemProps1.xml"] = _properties()
    parts["customXml/_rels/item1.xml.rels"] = _relationships([("customXmlProps", "itemProps1.xml")])
    properties = "application/vnd.openxmlformats-officedocument.customXmlProperties+xml"
    overrides.append(("/customXml/itemProps1.xml", properties))
    relations += [("connections", "connections.xml"), ("customXml", "../customXml/item1.xml")]
    _add(parts, "[Content_Types].xml", "</Types>", (_override(*one) for one in overrides))
    more = (_relationship(f"rIdQuery{at}", *one) for at, one in enumerate(relations))
    _add(parts, "xl/_rels/workbook.xml.rels", "</Relationships>", more)
    file = io.BytesIO()
    with ZipFile(file, "w", ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return file.getvalue()


def formulas() -> str:
    """Return the queries in the language M."""
    return "section Section1;\n\n" + "\n".join(_query(name, table) for name, table in TABLES.items())


def _query(name: str, table: Table[Any]) -> str:
    # Power Query knows ten millionths of a second, and the service tells nanoseconds.
    when = "each if _ = null then null else DateTime.FromText(Text.Start(_, 19)), type nullable datetime"
    times = [f'{{"{one.name}", {when}}}' for one in table.columns if one.type is ColumnType.TIME]
    types = {ColumnType.NUMBER: "type number", ColumnType.WHOLE: "Int64.Type", ColumnType.TEXT: "type text"}
    numbers = [f'{{"{one.name}", {types[one.type]}}}' for one in table.columns if one.type in types]
    return QUERY.format(name=name, table=table.name, times=", ".join(times), numbers=", ".join(numbers))


def _query_table(number: int, table: Table[Any]) -> bytes:
    fields = "".join(
        f'<queryTableField id="{at}" name={quoteattr(column.name)} tableColumnId="{at}"/>'
        for at, column in enumerate(table.columns, start=1)
    )
    return (
        f'{XML}<queryTable xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" '
        f'name="ExternalData_{number}" connectionId="{number}" autoFormatId="16" applyNumberFormats="0" '
        'applyBorderFormats="0" applyFontFormats="0" applyPatternFormats="0" applyAlignmentFormats="0" '
        f'applyWidthHeightFormats="0"><queryTableRefresh nextId="{len(table.columns) + 1}">'
        f'<queryTableFields count="{len(table.columns)}">{fields}</queryTableFields>'
        "</queryTableRefresh></queryTable>"
    ).encode()


def _connections() -> bytes:
    connections = "".join(
        f'<connection id="{number}" keepAlive="1" name="Query - {name}" '  # noqa: S608 - Excel's words
        f'description="Connection to the \'{name}\' query in the workbook." type="5" refreshedVersion="7" '
        'background="1" saveData="1"><dbPr connection="Provider=Microsoft.Mashup.OleDb.1;'
        f'Data Source=$Workbook$;Location={name};Extended Properties=&quot;&quot;" '
        f'command="SELECT * FROM [{name}]"/></connection>'
        for number, name in enumerate(TABLES, start=1)
    )
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    return f'{XML}<connections xmlns="{main}">{connections}</connections>'.encode()


def _mashup_part() -> bytes:
    mashup = base64.b64encode(_mashup()).decode()
    text = (
        '<?xml version="1.0" encoding="utf-16"?>'
        f'<DataMashup xmlns="http://schemas.microsoft.com/DataMashup">{mashup}</DataMashup>'
    )
    return text.encode("utf-16")


def _mashup() -> bytes:
    """Return the queries as Excel keeps them ([MS-QDEFF]): version, then parts with their lengths."""
    package = io.BytesIO()
    with ZipFile(package, "w", ZIP_DEFLATED) as archive:
        head = '<?xml version="1.0" encoding="utf-8"?>'
        archive.writestr(
            "Config/Package.xml",
            f"{head}<Package {SCHEMAS}><Version>2.99.202.0</Version><MinVersion>2.21.0.0</MinVersion>"
            "<Culture>en-US</Culture></Package>",
        )
        archive.writestr(
            "[Content_Types].xml",
            f'{head}<Types xmlns="{PACKAGE}/content-types"><Default Extension="xml" ContentType="text/xml" />'
            '<Default Extension="m" ContentType="application/x-ms-m" /></Types>',
        )
        archive.writestr("Formulas/Section1.m", formulas())
    permissions = (
        f"{head}<PermissionList {SCHEMAS}><CanEvaluateFuturePackages>false</CanEvaluateFuturePackages>"
        "<FirewallEnabled>true</FirewallEnabled></PermissionList>"
    )
    items = "".join(_item("Formula", f"Section1/{name}", _filled(name)) for name in TABLES)
    metadata = (
        f"{head}<LocalPackageMetadataFile {SCHEMAS}><Items>{_item('AllFormulas', '', {})}{items}</Items>"
        "</LocalPackageMetadataFile>"
    ).encode()
    described = struct.pack("<II", 0, len(metadata)) + metadata + struct.pack("<I", 0)
    binding = b""  # Windows' signature of the permissions; without it Excel takes the strict ones above
    return struct.pack("<I", 0) + b"".join(
        struct.pack("<I", len(part)) + part
        for part in (package.getvalue(), permissions.encode(), described, binding)
    )


def _filled(name: str) -> Mapping[str, str]:
    """Return where Excel puts what a query gives: l means a number, s a text."""
    return {
        "IsPrivate": "l0", "FillEnabled": "l1", "FillObjectType": "sTable", "FillToDataModelEnabled": "l0",
        "BufferNextRefresh": "l1", "ResultType": "sTable", "NameUpdatedAfterFill": "l0",
        "FillTarget": f"s{name}", "AddedToDataModel": "l0", "FillStatus": "sWaitingForExcelRefresh",
    }  # fmt: skip


def _item(kind: str, path: str, entries: Mapping[str, str]) -> str:
    stable = "".join(
        f"<Entry Type={quoteattr(one)} Value={quoteattr(value)} />" for one, value in entries.items()
    )
    return (
        f"<Item><ItemLocation><ItemType>{kind}</ItemType><ItemPath>{escape(path)}</ItemPath></ItemLocation>"
        f"<StableEntries>{stable}</StableEntries></Item>"
    )


def _properties() -> bytes:
    item = str(uuid.uuid4()).upper()
    return (
        f'{XML}<ds:datastoreItem ds:itemID="{{{item}}}" '
        'xmlns:ds="http://schemas.openxmlformats.org/officeDocument/2006/customXml"><ds:schemaRefs>'
        '<ds:schemaRef ds:uri="http://schemas.microsoft.com/DataMashup"/></ds:schemaRefs></ds:datastoreItem>'
    ).encode()


def _override(part: str, content_type: str) -> str:
    return f'<Override PartName="{part}" ContentType="{content_type}"/>'


def _relationship(name: str, kind: str, target: str) -> str:
    return f'<Relationship Id="{name}" Type="{RELATIONS}/{kind}" Target="{target}"/>'


def _relationships(relations: Sequence[tuple[str, str]]) -> bytes:
    told = "".join(_relationship(f"rId{at}", *one) for at, one in enumerate(relations, start=1))
    return f'{XML}<Relationships xmlns="{PACKAGE}/relationships">{told}</Relationships>'.encode()


def _add(parts: dict[str, bytes], part: str, end: str, elements: Iterable[str]) -> None:
    """Add elements before the end of a part."""
    parts[part] = parts[part].replace(end.encode(), ("".join(elements) + end).encode())


if __name__ == "__main__":
    main()
