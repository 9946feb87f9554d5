"""Our client against servers that do not stand on libiec61850, with the model of every relay profile.

Both come from the package registry: open61850 is written in Python, iec61850 in Rust. Neither has files.
"""

import asyncio
import queue
import tempfile
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

import iec61850
from open61850.server import IedModel, MmsServer

import scl
from benchmarks.interoperability.peers import Result
from ied_sim.profiles.profile import read_profile, shipped
from mms import Client, ControlModel, FunctionalConstraint, MmsError, Report, RequestRejected
from scl import Address
from testing.ports import LOOPBACK, free_port
from testing.relays.simulated import IED

PATIENCE_S = 10.0
UNBUFFERED = "URep51"
OF_LLN0 = ("Mod.stVal", "Beh.stVal", "Health.stVal")
"""Members of the data set that is declared at the server in Rust."""


def results() -> Iterator[Result]:
    """Yield every check of every profile."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-interoperability-") as directory:
        for name in shipped():
            yield from of_profile(name, Path(directory))


def of_profile(name: str, directory: Path) -> Iterator[Result]:
    """Yield every check of one profile's model, at both servers.

    Parameters
    ----------
    name : str
        The profile.
    directory : pathlib.Path
        Where the SCL file is written that the servers read.
    """
    model = _model(name, directory)
    yield from _checked(model, "open61850", _open61850(model), model.promised_members, model.block)
    declared = f"{model.block.partition('/')[0]}/LLN0.RP.{UNBUFFERED}"
    yield from _checked(model, "iec61850", _iec61850(model), len(OF_LLN0), declared)


@dataclass(frozen=True)
class _Model:
    """What the servers serve: an SCL file, and the profile's report block and stop of the motor in it."""

    name: str
    path: Path
    devices: list[str]
    promised_members: int
    block: str
    stop: str


def _model(name: str, directory: Path) -> _Model:
    path = directory / f"{name}.cid"
    profile = read_profile(name)
    scl.instantiate(profile.icd_path, path, IED, Address(LOOPBACK, free_port()))
    ied = scl.read(path).ied(IED)
    return _Model(
        name,
        path,
        devices=sorted(device.name for device in ied.logical_devices),
        promised_members=sum(len(each.members) for each in ied.data_sets()),
        block=f"{IED}{profile.points.reports}",
        stop=f"{IED}{profile.points.stop}",
    )


def _checked(
    model: _Model, server: str, serving: AbstractContextManager[int], promised: int, block: str
) -> Iterator[Result]:
    name = model.name
    with serving as port, Client.connect(LOOPBACK, port) as client:
        found = sorted(client.logical_devices())
        objects = sum(len(client.data_objects(node)) for node in _nodes(client))
        seen = f"{len(found)} devices, {objects} data objects"
        yield Result(name, f"{server}: browse", seen, found == model.devices)
        sets = [f"{node}.{each}" for node in _nodes(client) for each in client.data_sets(node)]
        values = sum(len(client.read_data_set(each)) for each in sets)
        yield Result(name, f"{server}: data sets", f"{len(sets)} of {values} members", values == promised)
        yield _reported(client, name, server, block)
        yield _operated(client, name, server, model.stop)
        yield _without_files(client, name, server)


def _nodes(client: Client) -> list[str]:
    return [
        f"{device}/{node}" for device in client.logical_devices() for node in client.logical_nodes(device)
    ]


def _reported(client: Client, name: str, server: str, block: str) -> Result:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    asked = f"{server}: reports"
    try:
        client.subscribe(block, reports, general_interrogation=True)
        members = len(reports.get(timeout=PATIENCE_S).members)
        client.unsubscribe(block)
    except (MmsError, queue.Empty) as error:
        return Result(name, asked, str(error) or "none came", passed=False)
    return Result(name, asked, f"{members} members", members > 0)


def _operated(client: Client, name: str, server: str, control: str) -> Result:
    asked = f"{server}: operate"
    try:
        client.operate(control, value=True)
        status = client.read(f"{control}.stVal", FunctionalConstraint.ST)
    except MmsError as error:
        return Result(name, asked, str(error), passed=False)
    return Result(name, asked, f"status {status!r}", status is True)


def _without_files(client: Client, name: str, server: str) -> Result:
    """A relay without a file service is told from one that breaks the protocol."""
    asked = f"{server}: files"
    try:
        listed = client.files()
    except RequestRejected:
        return Result(name, asked, "refused, as it should", passed=True)
    except MmsError as error:
        return Result(name, asked, str(error), passed=False)
    return Result(name, asked, f"{len(listed)} listed", passed=False)


@contextmanager
def _open61850(model: _Model) -> Iterator[int]:
    port = free_port()
    with MmsServer(IedModel.from_scl(model.path), port=port) as server:
        server.start()
        yield port


@contextmanager
def _iec61850(model: _Model) -> Iterator[int]:
    """Serve on a thread of its own, which runs the server's event loop.

    This server takes data objects from SCL. Its data sets, of one logical device each, report blocks and
    controls are declared beside. The block is an unbuffered one: it gives no buffered one as a whole, to its
    own client neither.
    """
    server = iec61850.IedServer.from_scl(model.path, ied_name=IED)
    device = model.block.removeprefix(IED).partition("/")[0]
    data_set = "LLN0$DSet01"
    server.add_dataset(data_set, [f"{device}/LLN0.{name}" for name in OF_LLN0])
    server.register_urcb(f"{device}/LLN0.{UNBUFFERED}", dataset=data_set, rpt_id="U1", trg_ops=["all"])
    control = model.stop.removeprefix(IED)
    server.on_control(
        control,
        ctl_model="direct-normal",
        operate=lambda _path, value, _action: server.update_bool(f"{control}.stVal", value),
    )
    port = free_port()
    server.bind(f"{LOOPBACK}:{port}")

    async def start() -> None:
        await server.start()

    async def stop() -> None:
        await server.stop()

    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    try:
        asyncio.run_coroutine_threadsafe(start(), loop).result(PATIENCE_S)
        server.update_int32(f"{control}.ctlModel", ControlModel.DIRECT_NORMAL)
        yield port
        asyncio.run_coroutine_threadsafe(stop(), loop).result(PATIENCE_S)
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join(PATIENCE_S)
        loop.close()
