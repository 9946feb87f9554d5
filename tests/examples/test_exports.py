"""The examples that read exports: against a service on a real port."""

import base64
import csv
import io
import posixpath
import re
import shutil
import struct
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from zipfile import ZipFile

import httpx
import openpyxl
import pytest
from lxml import etree

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Sample
from testing.not_installed import not_installed
from testing.service.conditions import FAULT, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable
from tests.docs.pages import ROOT
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    """A service that knows two recordings of PUMP-A1, the second of which cannot be diagnosed."""
    add_diagnosed(repository, store, fault(0.02), NOW_NS, name="E,1", observed=observation(0))
    add_diagnosed(repository, store, undiagnosable(), NOW_NS + 3600 * SECOND_NS, name="E2")
    repository.add_samples(Sample("PUMP-A1", NOW_NS + at * SECOND_NS, {"ia_A": 7.5}) for at in range(3))
    tell(repository, FAULT)
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


def token_of(client: httpx.Client) -> str:
    """A token that may look, and no more."""
    made = client.post("/api/v1/account/tokens", json={"label": "reader", "scope": ["view"]})
    return str(made.raise_for_status().json()["token"])


def test_python_reads_them(client: httpx.Client, tmp_path: Path) -> None:
    token = tmp_path / "statorwatch.token"
    token.write_text(f"{token_of(client)}\n")
    example = ROOT / "examples/read_exports.py"
    words = [sys.executable, str(example), str(client.base_url), "PUMP-A1", str(token)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        "2025-10-09 08:53 UTC fault           2.000% fault",
        "2025-10-09 09:53 UTC undiagnosable        - ",
        "2 recordings, 3 measurements, current of phase a: 7.5 A",
    ]


def test_a_workbook_with_queries(client: httpx.Client, tmp_path: Path) -> None:
    """As far as it can be seen without Excel: its parts belong together, and the queries are in them."""
    path = tmp_path / "motors.xlsx"
    words = [sys.executable, str(ROOT / "examples/make_excel_workbook.py"), str(client.base_url), str(path)]
    subprocess.run(words, capture_output=True, check=True)
    book = openpyxl.load_workbook(path)
    assert book.sheetnames == ["settings", "trend", "recordings", "alarms"]
    assert book["settings"]["B1"].value == str(client.base_url).rstrip("/")
    with ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    for name, content in parts.items():
        tree = etree.fromstring(content)
        if name.endswith(".rels"):
            folder = PurePosixPath(name).parent.parent
            for relation in tree:
                target = PurePosixPath(posixpath.normpath(folder / relation.get("Target", "")))
                assert str(target) in parts, f"{name} points to {target}"
        if name == "[Content_Types].xml":
            assert {one.get("PartName", "/")[1:] for one in tree} - {""} <= set(parts)
    for number, sheet in enumerate(("trend", "recordings", "alarms"), start=1):
        told = read_rows(client.get(f"/api/v1/exports/{sheet}").text)
        table = etree.fromstring(parts[f"xl/tables/table{number}.xml"])
        columns = table.findall(".//{*}tableColumn")
        assert [column.get("name") for column in columns] == told, "the columns that the service sends"
        assert [column.get("queryTableFieldId") for column in columns] == [
            str(at) for at in range(1, len(told) + 1)
        ]
    formulas = queries_of(parts["customXml/item1.xml"])
    assert formulas.count("shared ") == 3
    assert "Bearer " in formulas
    assert all(f'"{name}"' in formulas for name in told)


def test_grafana_gets_the_columns_that_its_page_names(client: httpx.Client) -> None:
    page = (ROOT / "docs/how-to/monitoring.md").read_text(encoding="utf-8")
    section = page.partition("### Grafana on the REST API")[2].partition("\n## ")[0]
    (url,) = re.findall(r"^    (/api/v1/\S+)$", section, re.MULTILINE)
    named = re.findall(r"^\| `(\w+)` \| (?:Time|Number) \|", section, re.MULTILINE)
    # Grafana's variables are the ends of the panel's time, as JavaScript writes a date.
    for variable, date in (("from", "2025-10-09T08:53:00.000Z"), ("to", "2025-10-09T09:00:00.000Z")):
        url = url.replace(f"${{__{variable}:date:iso}}", date)
    told = client.get(url, headers={"Authorization": f"Bearer {token_of(client)}"}).raise_for_status()
    (row,) = csv.DictReader(io.StringIO(told.text))
    assert len(named) == 4
    assert set(named) <= row.keys()
    assert float(row["mu_f"]) == pytest.approx(0.02)
    (other,) = re.findall(r"`(/api/v1/motors\S+)`", section)
    assert {one["name"] for one in client.get(other).raise_for_status().json()["items"]} >= {"PUMP-A1"}


def read_rows(text: str) -> list[str]:
    """The names of the columns of a CSV file."""
    return next(csv.reader(io.StringIO(text)))


def queries_of(part: bytes) -> str:
    """The queries of a workbook, from where Excel keeps them ([MS-QDEFF])."""
    mashup = base64.b64decode(etree.fromstring(part).text or "")
    version, length = struct.unpack("<II", mashup[:8])
    assert version == 0
    with ZipFile(io.BytesIO(mashup[8 : 8 + length])) as package:
        formulas = package.read("Formulas/Section1.m").decode()
    rest, lengths = mashup[8 + length :], []
    while rest:
        (length,) = struct.unpack("<I", rest[:4])
        lengths.append(length)
        rest = rest[4 + length :]
    assert len(lengths) == 3, "permissions, metadata, binding"
    return formulas


def test_octave_reads_them(client: httpx.Client) -> None:
    """MATLAB is not to be had here; its example that Octave can run too is run by Octave."""
    octave = shutil.which("octave-cli")
    if octave is None:
        not_installed("no GNU Octave: apt-get install --no-install-recommends octave")
    program = f"""
        addpath('{ROOT / "examples/matlab"}');
        trend = read_trend('{client.base_url}', 'PUMP-A1', '{token_of(client)}');
        printf('%s|', trend.motor{{:}}, trend.verdict{{:}}, trend.state{{:}});
        printf('%.4f|', trend.mu_f, trend.condition_level);
        printf('%s|', datestr(trend.time(1), 31));
    """
    done = subprocess.run(
        [octave, "--no-gui", "--norc", "--eval", program], capture_output=True, text=True, timeout=100
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == (
        "PUMP-A1|PUMP-A1|fault|undiagnosable|fault||0.0200|NaN|0.0121|NaN|2025-10-09 08:53:20|"
    )
