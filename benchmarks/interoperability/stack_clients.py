"""Clients that do not stand on libiec61850, from the package registry, against every relay profile.

open61850 and py61850 are written in Python, iec61850 in Rust; none shares code with libiec61850.
"""

import asyncio
import hashlib
import io
import queue
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import iec61850
import py61850
from open61850 import data as open_data
from open61850 import mms as open_mms
from open61850.mms import rcb as open_rcb

from benchmarks.interoperability.peers import Result
from ied_sim.profiles.profile import Profile, shipped
from mms import Client, FunctionalConstraint
from testing.relays.simulated import IED, Simulated, scenario_of, simulated
from testing.waiting import eventually

PATIENCE_S = 10.0
STANDSTILL_A, STANDSTILL_PATIENCE_S = 0.05, 30.0
"""More than a meter shows of a stopped motor, far less than it draws."""
POLL_MS = 100


def results() -> Iterator[Result]:
    """Yield every check of every profile."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-interoperability-") as directory:
        for name in shipped():
            yield from of_profile(name, Path(directory) / name)


def of_profile(name: str, directory: Path) -> Iterator[Result]:
    """Yield every check of one profile: the first client stops the motor, the second starts it.

    Parameters
    ----------
    name : str
        The profile.
    directory : pathlib.Path
        Where the relay keeps its files.
    """
    scenario = scenario_of(name)
    with simulated(directory, scenario) as served:
        yield from _by_open61850(scenario.profile, served)
        yield from asyncio.run(_by_iec61850(scenario.profile, served))
        yield from _by_py61850(scenario.profile, served)


def _by_open61850(profile: Profile, served: Simulated) -> Iterator[Result]:
    reports: queue.SimpleQueue[open_mms.InformationReport] = queue.SimpleQueue()
    with open_mms.MmsClient.connect(
        served.address.host, port=served.address.port, on_information_report=reports.put
    ) as client:
        model = open_mms.discover(client)
        devices = sorted({str(each).partition("/")[0] for each in model.references()})
        values = sum(1 for _ in model.references())
        yield Result(
            profile.name, "open61850: browse", f"{len(devices)} devices, {values} values",
            devices == _promised(served),
        )  # fmt: skip
        current = client.read(f"{_meter(profile, served)}.A.phsA.cVal.mag.f[MX]")
        is_float = isinstance(current, open_data.FloatData)
        yield Result(profile.name, "open61850: read a current", "a float", is_float)
        reference, members = _report_block(profile, served)
        device, _, item = reference.partition("/")
        block = open_mms.ObjectName(item.replace(".", "$"), device)
        open_rcb.enable(client, block)
        report = open_mms.decode_report(reports.get(timeout=PATIENCE_S))
        open_rcb.disable(client, block)
        seen = len(report.entries)
        yield Result(profile.name, "open61850: reports", f"{seen} members", seen == members)
        open_mms.operate(client, served.reference(str(profile.points.stop)), ctl_val=True)
        yield Result(profile.name, "open61850: operate", "motor stopped", _is_stopped(profile, served))


def _by_py61850(profile: Profile, served: Simulated) -> Iterator[Result]:
    host, port = served.address.host, served.address.port
    with py61850.MmsClient(host, port=port, timeout=PATIENCE_S) as client:
        devices = sorted(client.get_server_directory())
        names = sum(len(client.get_logical_device_directory(device)) for device in devices)
        yield Result(
            profile.name, "py61850: browse", f"{len(devices)} devices, {names} names",
            devices == _promised(served),
        )  # fmt: skip
        device, _, node = _meter(profile, served).partition("/")
        current = client.read_value(device, f"{node}$MX$A$phsA$cVal$mag$f")
        yield Result(profile.name, "py61850: read a current", "a float", isinstance(current, float))
        data_set = served.document.ied(IED).data_sets()[0]
        device, _, name = data_set.reference.partition("/")
        values = client.read_data_set(device, name.replace(".", "$"))
        yield Result(
            profile.name, "py61850: data set", f"{len(values)} members", len(values) == len(data_set.members)
        )
    with py61850.FileTransfer(host, port=port, timeout=PATIENCE_S) as files:
        yield _fetched_by_py61850(profile, served, files)


def _fetched_by_py61850(profile: Profile, served: Simulated, files: "py61850.FileTransfer") -> Result:
    """List the reports' folder, which every relay with files has, and get all that is in it."""
    if profile.files is None:
        try:
            listed = files.file_directory("/")
        except py61850.MmsError:
            return Result(profile.name, "py61850: files", "refused, as it should", passed=True)
        return Result(profile.name, "py61850: files", f"{len(listed)} listed", passed=False)
    with served.client() as client:
        trigger = profile.points.trigger[0] if profile.points.trigger else profile.points.start
        client.operate(served.reference(str(trigger)), value=True)
        folder = profile.files.folder
        eventually(
            lambda: any(each.name.upper().endswith(".CFG") for each in client.files(folder)), PATIENCE_S
        )
        expected = {each.name: _sha256_by_ours(client, each.name, each.size) for each in client.files(folder)}
    found = {}
    with tempfile.TemporaryDirectory(prefix="statorwatch-interoperability-") as directory:
        for entry in files.file_directory(folder):
            copy = Path(directory) / "copy"
            files.download_file(entry.name, str(copy))
            found[entry.name] = hashlib.sha256(copy.read_bytes()).hexdigest()
    same = sum(found.get(name) == digest for name, digest in expected.items())
    seen = f"SHA-256 of {same} of {len(expected)} equal"
    return Result(profile.name, "py61850: files", seen, same == len(expected) > 0)


async def _by_iec61850(profile: Profile, served: Simulated) -> list[Result]:
    client = await iec61850.IedConnection.connect(f"{served.address.host}:{served.address.port}")
    found = []
    try:
        devices = sorted(await client.get_server_directory())
        model = await client.get_device_model()
        names = sum(len(device["variables"]) for device in model["logical_devices"])
        seen = f"{len(devices)} devices, {names} names"
        found.append(Result(profile.name, "iec61850: browse", seen, devices == _promised(served)))
        meter = f"{_meter(profile, served)}.A.phsA.cVal.mag.f"
        current = await client.read_float(meter, iec61850.FC.MX)
        found.append(Result(profile.name, "iec61850: read a current", "a float", isinstance(current, float)))
        reference, members = _report_block(profile, served)
        number = await _reported_to_iec61850(client, reference)
        found.append(Result(profile.name, "iec61850: reports", f"{number} members", number == members))
        control = client.create_control_object(
            served.reference(str(profile.points.start)), iec61850.ControlModel.DIRECT_NORMAL
        )
        outcome = await control.operate(value=True)
        runs = outcome.success and await asyncio.to_thread(_is_running, profile, served)
        found.append(
            Result(profile.name, "iec61850: operate", "motor started" if runs else "not started", runs)
        )
    finally:
        await client.disconnect()
    return found


async def _reported_to_iec61850(client: "iec61850.IedConnection", block: str) -> int:
    """Return the number of members of a report by general interrogation."""
    reports: list[iec61850.ClientReport] = []
    values = await client.get_rcb_values(block)
    await client.install_report_handler(block, reports.append, rpt_id=values.rpt_id)
    values.rpt_ena = True
    await client.set_rcb_values(values, iec61850.RcbWriteMask.fields("rpt_ena"))
    await client.trigger_gi(block)
    for _ in range(round(PATIENCE_S * 1000 / POLL_MS)):
        if reports:
            break
        await client.poll_reports(POLL_MS)
    return len(reports[0].entries) if reports else 0


def _promised(served: Simulated) -> list[str]:
    """Return the logical devices of the relay's SCL."""
    return sorted(device.name for device in served.document.ied(IED).logical_devices)


def _meter(profile: Profile, served: Simulated) -> str:
    return served.reference(str(profile.points.metering))


def _report_block(profile: Profile, served: Simulated) -> tuple[str, int]:
    """Return the reference of the profile's report block and the size of its data set."""
    block = served.reference(str(profile.points.reports))
    with served.client() as client:
        name = client.read(f"{block.replace('.BR.', '.')}.DatSet", FunctionalConstraint.BR)
        return block, len(client.data_set_directory(str(name).replace("$", ".")))


def _is_stopped(profile: Profile, served: Simulated) -> bool:
    return _comes_to(profile, served, lambda current_A: current_A < STANDSTILL_A)


def _is_running(profile: Profile, served: Simulated) -> bool:
    return _comes_to(profile, served, lambda current_A: current_A > STANDSTILL_A)


def _comes_to(profile: Profile, served: Simulated, condition: Callable[[float], bool]) -> bool:
    """Wait until the metered current meets a condition; return whether it did."""
    reference = f"{_meter(profile, served)}.A.phsA.cVal.mag.f"
    with served.client() as client:
        return eventually(
            lambda: condition(float(str(client.read(reference, FunctionalConstraint.MX)))),
            STANDSTILL_PATIENCE_S,
        )


def _sha256_by_ours(client: Client, name: str, size: int) -> str:
    content = io.BytesIO()
    client.download(name, content, expected_size=size)
    return hashlib.sha256(content.getvalue()).hexdigest()
