"""The client of a Dask scheduler, in a process of its own that the service does not trust.

It takes tasks as bytes on its standard input and gives back texts on its standard output, a line of JSON
each. It has no settings and no database. With a scheduler that somebody else started it has no secrets in its
environment either, and reads no objects from pickles.
"""

import asyncio
import base64
import json
import logging
import os
import signal
import sys
import warnings
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from typing import TYPE_CHECKING, Any, Final

from service.jobs.plain_unpickler import refuse_objects

if TYPE_CHECKING:
    from distributed import Client

CONNECT_TIMEOUT_S: Final = 20.0
WORKERS_TIMEOUT_S: Final = 60.0
"""For all workers to say what software they have."""

CLOSE_TIMEOUT_S: Final = 5.0
CONNECTED: Final = "running"
POLL_PERIOD_S: Final = 0.05
LONGEST_LINE: Final = 64 * 1024**2
SETTLE_S: Final = 0.5
"""Within which the client notices that its scheduler is gone, after a request that failed for it."""

PLAIN: Final = ["msgpack", "error"]
"""Numbers, texts and lists, and the words of an error."""

Tell = Callable[[dict[str, object]], None]


def main() -> None:
    """Serve one service until it closes the standard input, or the scheduler is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    answers = os.fdopen(os.dup(1), "w", encoding="ascii")
    os.dup2(2, 1)  # libraries may print

    def tell(message: dict[str, object]) -> None:
        answers.write(f"{json.dumps(message)}\n")
        answers.flush()

    with suppress(BrokenPipeError):
        asyncio.run(_serve(tell))


async def _serve(tell: Tell) -> None:
    lines = asyncio.StreamReader(limit=LONGEST_LINE)
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(lines), sys.stdin.buffer
    )
    order = json.loads(await lines.readline())
    if order["address"] is not None:
        refuse_objects()  # before anything of Dask is imported
    warnings.simplefilter("ignore")
    async with AsyncExitStack() as ending:
        try:
            client = await ending.enter_async_context(_client(order))
            about = await _about_workers(client, order)
        except Exception as error:  # noqa: BLE001 - of any kind, for people to read
            tell({"kind": "refused", "reason": f"{error}"})
            return
        tell({"kind": "ready", **about})
        await _give_out(client, lines, tell)


@asynccontextmanager
async def _client(order: dict[str, Any]) -> AsyncIterator["Client"]:
    """Connect to the scheduler that is named, or to one with workers of this machine.

    The latter ends with the block. Nobody else reaches it: its connections are encrypted.
    """
    import dask.config
    from distributed import Client, LocalCluster

    _silence()
    if order["address"] is None:
        cluster = LocalCluster(
            n_workers=order["processes"],
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            security=True,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
            asynchronous=True,
        )
        async with cluster, Client(cluster, asynchronous=True, set_as_default=False) as client:
            yield client
        return
    dask.config.set({"distributed.scheduler.allowed-imports": []})  # what messages may have imported
    client = Client(
        order["address"],
        timeout=CONNECT_TIMEOUT_S,
        security=_security(order["tls"]),
        deserializers=PLAIN,
        asynchronous=True,
        set_as_default=False,
    )
    try:
        yield await client
    finally:
        with suppress(TimeoutError, OSError):
            await asyncio.wait_for(client.close(), CLOSE_TIMEOUT_S)


def _security(tls: dict[str, str] | None) -> Any:
    """Return both sides' certificates for Dask; without them nothing of Dask's own configuration is used."""
    from distributed import Security

    if tls is None:
        return Security(require_encryption=False)
    return Security(
        require_encryption=True,
        tls_ca_file=tls["ca"],
        tls_client_cert=tls["certificate"],
        tls_client_key=tls["key"],
    )


async def _about_workers(client: "Client", order: dict[str, Any]) -> dict[str, object]:
    """Return how many threads each worker has, and what it says of itself."""
    from service.jobs.dask_tasks import describe_worker

    async with asyncio.timeout(WORKERS_TIMEOUT_S):
        scheduler: Any = client.scheduler
        threads = await scheduler.ncores()
        if order["store"] is None or not threads or set(threads.values()) != {1}:
            return {"threads": threads, "descriptions": {}}
        store = base64.b64decode(order["store"])
        descriptions: dict[str, object] = await client.run(describe_worker, store, on_error="return")
    told = {worker: one if isinstance(one, str) else None for worker, one in descriptions.items()}
    return {"threads": threads, "descriptions": told}


async def _give_out(client: "Client", lines: asyncio.StreamReader, tell: Tell) -> None:
    """Give out tasks as they come, until no more can come or the scheduler is gone."""
    watching = asyncio.create_task(_gone(client))
    tasks: set[asyncio.Task[None]] = set()
    while True:
        reading = asyncio.create_task(lines.readline())
        await asyncio.wait({watching, reading}, return_when=asyncio.FIRST_COMPLETED)
        if watching.done():
            tell({"kind": "gone"})
            os._exit(0)  # the client would wait for its scheduler
        if not (line := reading.result()):
            break
        task = asyncio.create_task(_answer(client, json.loads(line), tell))
        tasks.add(task)
        task.add_done_callback(tasks.discard)
    for unfinished in (watching, *tasks):
        unfinished.cancel()


async def _gone(client: "Client") -> None:
    """Wait until the scheduler is gone, or has sent what the client refuses, which ends its listening."""
    listening: asyncio.Task[None] | None = getattr(client, "_handle_report_task", None)
    while client.status == CONNECTED and (listening is None or not listening.done()):
        await asyncio.sleep(POLL_PERIOD_S)


async def _answer(client: "Client", order: dict[str, Any], tell: Tell) -> None:
    """Have a worker do a task, and give its text back."""
    from service.jobs.dask_tasks import MOST_CHARACTERS, answer_task

    message: dict[str, object] = {"kind": "answer", "id": order["id"], "text": None, "failure": None}
    try:
        work = base64.b64decode(order["work"])
        text = await client.submit(answer_task, work, order["timeout_s"], pure=False)
        if isinstance(text, str) and len(text) <= MOST_CHARACTERS:
            message["text"] = text
        else:
            message["failure"] = "a worker answered something else than a text of bearable length"
    except Exception:  # noqa: BLE001 - what it is of, cannot be read: it comes as a pickle
        await asyncio.sleep(SETTLE_S)
        if client.status != CONNECTED:
            return  # no fault of this task: the service is told that the scheduler is gone
        message["failure"] = "the worker process died or took too long, or its answer is no plain text"
    tell(message)


def _silence() -> None:
    """Leave it to the service to say that a connection is lost; Dask and Tornado tell it in many lines."""
    for name in logging.root.manager.loggerDict:
        if name.partition(".")[0] in {
            "distributed",
            "tornado",
        }:  # Dask gives several of them levels of their own
            logging.getLogger(name).setLevel(logging.CRITICAL)


if __name__ == "__main__":
    main()
