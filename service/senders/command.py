"""A program of this machine that passes a message on. No shell is involved, nor any word of the message.

The program gets the message as JSON on its standard input, and the words of its command line from the
settings alone: names of motors and notes of people reach it as data. It sees none of the service's variables,
of which some are secrets.
"""

import asyncio
import contextlib
import json
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from tempfile import TemporaryFile

from core.error_words import one_line
from service.configuration.channels import CommandChannel
from service.senders.errors import SendError
from service.senders.message import Message

PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"

MOST_KEPT_BYTES = 4096
"""The last line that a program writes to standard error says why it failed."""

LAST_WORDS_S = 1.0
"""Time to read it after the program's end; a process that it leaves behind may hold the pipe open."""


async def run_command(channel: CommandChannel, message: Message) -> None:
    """Run the program until it ends; exit code 0 says that it has passed the message on. Raises SendError."""
    program = channel.command[0]
    document = {**message.document, "text": message.text}
    with TemporaryFile() as given:
        given.write(json.dumps(document, ensure_ascii=False, allow_nan=False).encode())
        given.seek(0)
        async with _standard_error() as (complaint, pipe):
            try:
                process = await asyncio.create_subprocess_exec(
                    *channel.command,
                    stdin=given,
                    stdout=asyncio.subprocess.DEVNULL,
                    stderr=pipe,
                    env={"PATH": PATH, "LANG": "C.UTF-8"},
                    cwd="/",
                    start_new_session=True,
                )
            except OSError as error:
                reason = f"{program}: expected a program that can be run, found: {error.strerror}"
                raise SendError(reason) from error
            finally:
                os.close(pipe)
            code = await _end(process)
            if code == 0:
                return
            why = await _last_line(complaint)
            raise SendError(f"{program} ended with exit code {code}" + (f": {why}" if why else ""))


async def _end(process: asyncio.subprocess.Process) -> int:
    """Wait for the program's end, and end whatever it leaves behind. Returns its exit code."""
    try:
        return await process.wait()
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        await process.wait()


@asynccontextmanager
async def _standard_error() -> AsyncIterator[tuple["asyncio.Task[bytes]", int]]:
    """Make a pipe whose content is read all the time; yield the task that reads, and the end to write to."""
    reading, writing = os.pipe()
    reader = asyncio.StreamReader()
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(reading, "rb", buffering=0)
    )
    task = asyncio.create_task(_end_of(reader))
    try:
        yield task, writing
    finally:
        task.cancel()
        transport.close()


async def _end_of(reader: asyncio.StreamReader) -> bytes:
    """Read until the end, and keep little of it."""
    kept = b""
    while read := await reader.read(MOST_KEPT_BYTES):
        kept = (kept + read)[-MOST_KEPT_BYTES:]
    return kept


async def _last_line(complaint: "asyncio.Task[bytes]") -> str:
    try:
        async with asyncio.timeout(LAST_WORDS_S):
            kept = await complaint
    except TimeoutError:
        return ""
    lines = kept.decode("utf-8", "replace").strip().splitlines()
    return one_line(lines[-1]) if lines else ""
