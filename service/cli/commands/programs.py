"""Commands that run the service, or a demo of it."""

from pathlib import Path
from typing import Annotated

import typer

from service.cli.commands.options import DEFAULT_URL, Config, Json, Url

commands = typer.Typer()


@commands.command()
def demo(
    *,
    once: Annotated[
        bool, typer.Option("--once", help="Trigger every motor twice, print the diagnoses, stop; no month.")
    ] = False,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write the results to FILE.")
    ] = None,
    data: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Keep the data here (default: a temporary folder).")
    ] = None,
    url: Annotated[
        str | None,
        typer.Option(help="Start nothing: play on the demo plant whose service answers here."),
    ] = None,
) -> None:
    """Run a simulated plant of two factories and the service that watches it: a month in five minutes.

    Afterwards the plant's time is the real one, until Ctrl-C.
    """
    from service.cli.demo.demonstrate import demonstrate

    if url is not None and data is not None:
        raise typer.BadParameter("--data is for a plant this command starts: leave out --data or --url")
    demonstrate(once=once, json_file=json_file, data=data, url=url)


@commands.command("demo-status")
def demo_status(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show each motor's condition beside the truth at its latest record, where a demo plant runs."""
    from service.cli.demo.status import show_demo

    show_demo(url, as_json=as_json)


@commands.command()
def serve(
    config: Config = None,
) -> None:
    """Run the service: API, collectors and diagnosis workers. Ends on SIGTERM or Ctrl-C."""
    from service.cli.run_service import run_service

    run_service(config)


@commands.command()
def collect(
    config: Config = None,
) -> None:
    """Run gateways alone, which share the relays of a service on another host. Ends on SIGTERM or Ctrl-C."""
    from service.cli.run_service import run_gateways

    run_gateways(config)


@commands.command()
def work(
    config: Config = None,
) -> None:
    """Run diagnosis workers alone, for a service on another host (PostgreSQL). Ends on SIGTERM or Ctrl-C."""
    from service.cli.run_service import run_workers

    run_workers(config)
