"""python -m benchmarks.gateways.pictures: what clients of other makers see of a plant, as pictures.

Needs a demo that runs and whose month is over: `mcc demo --data DIRECTORY`. The gateways are started here, on
the demo's database; their ports must be free. A client that is not installed is left out, and named.
"""

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import httpx
from PIL import Image, ImageOps

from benchmarks.gateways.terminal import COLOURS, Said, draw, octave_session, python_session, run
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from testing.ports import LOOPBACK
from testing.service.gateways import running_gateways
from testing.service.mosquitto import PATH, Mosquitto, program, running_mosquitto
from testing.web.chromium import INSTALL, chromium_path, running_browser

ROOT = Path(__file__).parents[2]
MQTT_PORT, MMS_PORT, MODBUS_PORT, OPC_UA_PORT, IEC_104_PORT = 1883, 10_102, 1502, 4840, 2404
TABLES: Mapping[str, Mapping[str, object]] = {
    "mqtt": {"port": MQTT_PORT, "sparkplug": {"group": "StatorWatch", "edge_node": "statorwatch"}},
    "iec61850": {"port": MMS_PORT},
    "modbus": {"port": MODBUS_PORT},
    "opcua": {"port": OPC_UA_PORT, "anonymous": True, "unencrypted": True},
    "iec104": {"port": IEC_104_PORT},
}
OPEN62541 = ROOT / ".venv/open62541"
WORKBOOK = "excel"
HEARD_S = 5
MARGIN = 12


@dataclass(frozen=True, slots=True)
class Plant:
    """The demo, with its data directory, the file of a token that may look, and the motor that is shown.

    npm: folder with the packages that a client in JavaScript needs; None where there is none.
    """

    data: Path
    url: str
    token: Path
    motor: str
    npm: Path | None

    def first_of(self, table: str, column: str) -> int:
        """Return the motor's first register, or address, by the table that the gateway has written."""
        with (self.data / table).open(encoding="utf-8", newline="") as file:
            return next(int(row[column]) for row in csv.DictReader(file) if row["motor"] == self.motor)

    def get(self, path: str) -> bytes:
        """Read from the REST API."""
        headers = {"Authorization": f"Bearer {self.token.read_text().strip()}"}
        answer = httpx.get(f"{self.url}/api/v1{path}", headers=headers, timeout=60)
        return answer.raise_for_status().content


def main() -> None:
    """Write the pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="the demo's folder")
    parser.add_argument("--token", type=Path, required=True, help="file with the demo's token")
    parser.add_argument("--url", default="http://127.0.0.1:8710")
    parser.add_argument("--motor", default="PUMP-A1")
    parser.add_argument("--npm", type=Path, help="folder where `npm install mqtt sparkplug-payload` was run")
    names = [*SCREENS, WORKBOOK]
    parser.add_argument(
        "--only", nargs="+", choices=names, default=names, help="pictures; all where left out"
    )
    parser.add_argument("--folder", type=Path, default=ROOT / "docs/images/integration")
    wanted = parser.parse_args()
    chromium = chromium_path()
    if chromium is None:
        sys.exit(f"no chromium: {INSTALL}")
    wanted.folder.mkdir(parents=True, exist_ok=True)
    gateways = GatewaysSettings.model_validate(TABLES)
    settings = Settings(data_directory=wanted.data, gateways=gateways)
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        broker = running_mosquitto(Path(directory), port=MQTT_PORT)
        with broker as mosquitto, running_gateways(settings), running_browser(chromium) as browser:
            plant = Plant(wanted.data, wanted.url, wanted.token, wanted.motor, wanted.npm)
            for name, screen in SCREENS.items():
                if name not in wanted.only:
                    continue
                lacks = screen.lacks(plant)
                if lacks:
                    print(f"{name}: left out, {lacks}")
                else:
                    draw(browser, screen.said(plant, mosquitto), wanted.folder / f"{name}.png")
            if WORKBOOK in wanted.only:
                _workbook(plant, Path(directory), wanted.folder / f"{WORKBOOK}.png")


def _opc_ua(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    figures = ("State", "Kind", "Phase", "FaultLevel", "FaultLevelLow", "FaultLevelHigh", "AsOf", "Advice")
    return python_session(
        "open62541 (package o6 2.2.0)",
        [
            f'client = o6.Client("opc.tcp://{LOOPBACK}:{OPC_UA_PORT}/")',
            "client.connect()",
            *(f'client.read("ns=2;s=motor/{plant.motor}/{figure}")' for figure in figures),
        ],
        before=["import sys", f"sys.path.insert(0, {str(OPEN62541)!r})", "import o6"],
        hidden=["client.connect()"],
    )


def _iec61850(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    device = f"MCC{plant.motor.replace('-', '_')}"
    points = (
        "ZMOT1.EEHealth.stVal[ST]",
        "GAPC1.Op.general[ST]",
        "GAPC1.Op.phsA[ST]",
        "GAPC1.Op.phsB[ST]",
        "GGIO1.AnIn1.mag.f[MX]",
        "GGIO1.AnIn1.d[DC]",
        "MSQI1.ImbNgA.mag.f[MX]",
        "LPHD1.PhyHealth.stVal[ST]",
    )
    return python_session(
        "open61850 0.9.12, a client that does not stand on libiec61850",
        [
            f'client = MmsClient.connect("{LOOPBACK}", port={MMS_PORT})',
            'sorted({str(one).partition("/")[0] for one in discover(client).references()})',
            *(f'client.read("{device}/{point}")' for point in points),
            'client.read("MCCPLANT/CALH1.GrAlm.stVal[ST]")',
        ],
        before=["from open61850.mms import MmsClient, discover"],
    )


def _modbus(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    first = plant.first_of("modbus-map.csv", "first register")
    said = []
    for kind, start, count in (("3", first, 6), ("3:float", first + 10, 6)):
        options = f"-0 -1 -q -B -p {MODBUS_PORT} -t {kind} -r {start} -c {count} {LOOPBACK}"
        said.append(run(["mbpoll", *options.split()], shown=f"mbpoll {options}"))
    return said


def _mqtt(plant: Plant, mosquitto: Mosquitto) -> Sequence[Said]:
    heard = [f"statorwatch/motors/+/{plant.motor}/state", "statorwatch/status"]
    options = ["-p", str(mosquitto.port), *(word for topic in heard for word in ("-t", topic))]
    shown = " ".join(f"-t '{topic}'" for topic in heard)
    listener = subprocess.run(
        [program("mosquitto_sub"), *options, "-F", "%t\n  %p", "-W", str(HEARD_S)],
        capture_output=True,
        text=True,
        check=False,  # it ends by its limit of time
    )
    return [Said(f"mosquitto_sub {shown} -F '%t\\n  %p'", listener.stdout)]


def _sparkplug(plant: Plant, mosquitto: Mosquitto) -> Sequence[Said]:
    """Show the birth of the edge node, and that of the motor alone."""
    assert plant.npm is not None
    example = shutil.copy(ROOT / "examples/sparkplug_host.mjs", plant.npm)
    address = f"mqtt://{LOOPBACK}:{mosquitto.port}"
    command = ["timeout", str(HEARD_S), "node", example, address]
    host = subprocess.run(command, capture_output=True, text=True, check=False, cwd=plant.npm)  # ends by time
    Path(example).unlink()
    blocks = re.split(r"^(?=spBv1)", host.stdout, flags=re.MULTILINE)
    shown = [one for one in blocks if "/NBIRTH/" in one or one.split(" ")[0].endswith(f"/{plant.motor}")]
    return [Said(f"node examples/sparkplug_host.mjs {address}", "".join(shown[:2]))]


def _iec104(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    first = plant.first_of("iec104-map.csv", "first address")
    points = (
        ("fault", 1, "M_SP_TB_1"),
        ("level", 2, "M_ME_TF_1"),
        ("lower", 3, "M_ME_TF_1"),
        ("upper", 4, "M_ME_TF_1"),
        ("phase", 9, "M_ME_TE_1"),
    )
    return python_session(
        "c104 2.2.1 (lib60870)",
        [
            "client = c104.Client()",
            f'link = client.add_connection("{LOOPBACK}", {IEC_104_PORT}, init=c104.Init.NONE)',
            "station = link.add_station(1)",
            *(
                f"{name} = station.add_point({first + offset}, c104.Type.{kind})"
                for name, offset, kind in points
            ),
            "client.start()",
            "while link.state != c104.ConnectionState.OPEN: time.sleep(0.1)",
            "",
            *(f"{name}.read()" for name, _, _ in points),
            *(f"{name}.value, {name}.quality.is_good()" for name, _, _ in points[:1]),
            *(f"{name}.value" for name, _, _ in points[1:]),
            "print(level.recorded_at)",
            "client.stop()",
        ],
        before=["import c104, time"],
        hidden=["", f"time.sleep({HEARD_S})", "client.stop()"],
    )


def _python(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    examples = ("trend_to_pandas.py", "read_exports.py")
    return [
        run(
            [sys.executable, str(ROOT / "examples" / name), plant.url, plant.motor, str(plant.token)],
            shown=f"python examples/{name} {plant.url} {plant.motor} statorwatch.token",
            environment={**os.environ, "PYTHONPATH": str(ROOT / "client")},
        )
        for name in examples
    ]


def _octave(plant: Plant, _: Mosquitto) -> Sequence[Said]:
    octave = shutil.which("octave-cli")
    assert octave is not None
    return octave_session(
        octave,
        [
            f"trend = read_trend('{plant.url}', '{plant.motor}', token);",
            "size(trend.time)",
            "datestr(trend.time(end))",
            "trend.state{end}, trend.phase{end}",
            "100 * trend.condition_level(end)",
            "median(100 * trend.mu_f(strcmp(trend.state, 'fault')))",
        ],
        before=[
            f"addpath('{ROOT / 'examples/matlab'}');",
            f"token = strtrim(fileread('{plant.token}'));",
        ],
    )


def _workbook(plant: Plant, directory: Path, picture: Path) -> None:
    """Draw the first page of the trend as a workbook, as LibreOffice shows it."""
    office, pdftoppm = shutil.which("soffice"), shutil.which("pdftoppm")
    if office is None or pdftoppm is None:
        print("excel: left out, no soffice or no pdftoppm: apt-get install libreoffice-calc poppler-utils")
        return
    book = directory / "trend.xlsx"
    book.write_bytes(plant.get(f"/exports/trend?format=xlsx&motor={plant.motor}"))
    profile = f"-env:UserInstallation=file://{directory}/office"
    convert = ["--headless", profile, "--convert-to", "pdf", "--outdir", str(directory), str(book)]
    subprocess.run([office, *convert], check=True, capture_output=True)
    page = [pdftoppm, "-png", "-r", "80", "-f", "1", "-singlefile", str(book.with_suffix(".pdf"))]
    subprocess.run([*page, str(directory / "page")], check=True)
    with Image.open(directory / "page.png") as image:
        left, top, right, bottom = ImageOps.invert(image.convert("L")).getbbox() or (0, 0, *image.size)
        shown = image.convert("RGB").crop((left - MARGIN, top - MARGIN, right + MARGIN, bottom + MARGIN))
    shown.quantize(COLOURS).save(picture, optimize=True)


@dataclass(frozen=True, slots=True)
class Screen:
    """What a client says, and what it needs: a program, or a folder."""

    said: Callable[[Plant, Mosquitto], Sequence[Said]]
    program: str | None = None
    folder: Path | None = None
    needs_npm: bool = False

    def lacks(self, plant: Plant) -> str | None:
        """Return what is not installed; None where all is."""
        if self.needs_npm and plant.npm is None:
            return "no --npm"
        if self.program is not None and shutil.which(self.program, path=PATH) is None:
            return f"no {self.program}"
        if self.folder is not None and not self.folder.is_dir():
            return f"no {self.folder}"
        return None


SCREENS: Mapping[str, Screen] = {
    "opcua": Screen(_opc_ua, folder=OPEN62541),
    "iec61850": Screen(_iec61850),
    "modbus": Screen(_modbus, program="mbpoll"),
    "mqtt": Screen(_mqtt, program="mosquitto_sub"),
    "sparkplug": Screen(_sparkplug, program="node", needs_npm=True),
    "iec104": Screen(_iec104),
    "python": Screen(_python),
    "octave": Screen(_octave, program="octave-cli"),
}


if __name__ == "__main__":
    main()
