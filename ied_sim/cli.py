"""The command `ied-sim`: serve the simulated relays of a plant, or print the true condition of its motors."""

import json
import logging
import signal
import sys
import tempfile
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer

import scl
from core.units import NANOSECONDS_PER_SECOND
from ied_sim import warm_up
from ied_sim.errors import ScenarioError, SimulatorError, TableError
from ied_sim.plant_files import HIGHEST_PORT, consecutive_addresses, read_plant
from ied_sim.profiles.profile import DEFAULT, read_profile, shipped
from ied_sim.profiles.standalone import IED_NAME, standalone
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.plant_clock import REAL_TIME, ClockSettings
from ied_sim.scenario.scenario import healthy_reference, read_clock, read_scenario
from ied_sim.simulator import Simulator
from mms import filter_tls_log_from_stderr
from mms.goose import RawSocketError
from scl import Address

HOST = "127.0.0.1"
PORT = 10102

app = typer.Typer(add_completion=False, context_settings={"help_option_names": ["-h", "--help"]})


def _print_version(wanted: bool) -> None:
    if wanted:
        _say(f"ied-sim {version('statorwatch')}")
        raise typer.Exit


def _print_profiles(wanted: bool) -> None:
    if wanted:
        for name in shipped():
            _say(f"{name:<16}{read_profile(name).description}")
        raise typer.Exit


@app.command()
def ied_sim(
    scd: Annotated[
        list[Path] | None,
        typer.Option("--scd", help="SCL file of any make (SCD, CID, IID, ICD); may be given again."),
    ] = None,
    profile: Annotated[
        str | None,
        typer.Option(
            help="One relay of this kind (a name, or a .toml file); with --scd the kind of its relays."
        ),
    ] = None,
    ied: Annotated[
        list[str] | None, typer.Option("--ied", help="Serve this relay only; may be given again.")
    ] = None,
    host: Annotated[
        str | None, typer.Option(help=f"Address to listen at, in place of the file's; default {HOST}.")
    ] = None,
    port: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=HIGHEST_PORT,
            help=f"Port to listen at, in place of the file's; each further relay one higher; default {PORT}.",
        ),
    ] = None,
    scenario: Annotated[
        Path | None,
        typer.Option(help="Motors, loads and faults (docs/reference/scenario.md); healthy motors without."),
    ] = None,
    files: Annotated[
        Path | None, typer.Option(help="Directory that keeps the relays' files; a temporary one without.")
    ] = None,
    goose_interface: Annotated[
        str | None,
        typer.Option(
            help="Publish the relays' GOOSE control blocks on this network interface (needs CAP_NET_RAW)."
        ),
    ] = None,
    truth: Annotated[
        bool, typer.Option("--truth", help="Print the motors' true condition as JSON and stop.")
    ] = False,
    at: Annotated[
        list[float] | None,
        typer.Option(
            metavar="SECONDS",
            min=0.0,
            max=1e9,
            help="With --truth: time since the scenario's beginning; given several times, a list is printed.",
        ),
    ] = None,
    _profiles: Annotated[
        bool,
        typer.Option("--profiles", callback=_print_profiles, is_eager=True, help="List profiles and stop."),
    ] = False,
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and stop."),
    ] = False,
) -> None:
    """Serve simulated motor relays over IEC 61850 MMS until interrupted."""
    if not scd and profile is None:
        raise typer.BadParameter("give --scd or --profile")
    logging.basicConfig(stream=sys.stderr, level=logging.INFO, format="%(levelname)s %(name)s: %(message)s")
    try:
        if scd:
            document = read_plant(scd)
        else:
            name = ied[0] if ied else IED_NAME
            document = standalone(read_profile(profile or DEFAULT), name, Address(host or HOST, port or PORT))
        names = ied or [found.name for found in document.ieds]
        scenarios = _scenarios(document, scenario, profile or DEFAULT)
        clock = REAL_TIME if scenario is None else read_clock(scenario)
        if truth:
            told = [
                {name: scenarios[name].truth(time_s) for name in names if document.ied(name)}
                for time_s in at or [0.0]
            ]
            _say(json.dumps(told if len(told) > 1 else told[0]))
            return
        given = host is not None or port is not None
        addresses = consecutive_addresses(document, names, host or HOST, port or PORT) if given else {}
        _serve(document, names, scenarios, files, clock, addresses, goose_interface)
    except (SimulatorError, TableError, RawSocketError, scl.SclError, OSError) as error:
        typer.echo(f"ied-sim: {error}", err=True)
        raise typer.Exit(1) from error


def main() -> None:
    """Entry point of the command."""
    app()


def _scenarios(document: scl.Scl, path: Path | None, profile: str) -> dict[str, RelayConfiguration]:
    """Return a configuration for every IED: that of the scenario file, or the healthy reference motor."""
    scenarios = {found.name: healthy_reference(found.name, profile) for found in document.ieds}
    given = {} if path is None else read_scenario(path, profile)
    for name in given:
        if name not in scenarios:
            raise ScenarioError(
                path or "",
                f"[motor {name}] ied",
                expected=f"an IED of {document.path} ({', '.join(scenarios)})",
                found=name,
            )
    return scenarios | given


def _serve(
    document: scl.Scl,
    names: list[str],
    scenarios: dict[str, RelayConfiguration],
    files: Path | None,
    clock: ClockSettings,
    addresses: dict[str, Address],
    goose_interface: str | None,
) -> None:
    # The signals are waited for, not handled. They are blocked before any thread starts, so all inherit that.
    signals = (signal.SIGTERM, signal.SIGINT)
    signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    if any(scenario.access.tls is not None for scenario in scenarios.values()):
        filter_tls_log_from_stderr()
    warm_up()
    with (
        tempfile.TemporaryDirectory(prefix="ied-sim-") as temporary,
        Simulator(
            document,
            scenarios,
            files=files or Path(temporary),
            ieds=names,
            clock=clock,
            addresses=addresses,
            goose_interface=goose_interface,
        ) as simulator,
    ):
        for name, address in simulator.addresses.items():
            _say(f"{name} {address.host} {address.port}")
        if clock != REAL_TIME:
            began = datetime.fromtimestamp(simulator.epoch_ns / NANOSECONDS_PER_SECOND, UTC)
            _say(f"began {began.isoformat()}")
        _say("ready")
        signal.sigwait(signals)


def _say(line: str) -> None:
    """Write a line to stdout at once, because programs that start this one read it through a pipe."""
    print(line, flush=True)  # noqa: T201
