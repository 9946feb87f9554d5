"""A Dask scheduler that says what it likes: it speaks the protocol, and puts pickles of its own into it.

    python -m testing.service.hostile_scheduler ATTACK FOLDER [TEXT]

The pickles make the folder when somebody reads them as objects. It prints its address. TEXT is what its one
worker, which there is none of, answers to every task.
"""

import asyncio
import json
import os
import pickle
import sys
from collections.abc import Callable
from typing import Any, Final

from distributed.comm.core import Comm, CommClosedError, listen
from distributed.protocol.serialize import Serialize, Serialized, ToPickle

from service.jobs.dask_tasks import software

WORKER: Final = "tcp://127.0.0.1:1"
HONEST: Final = "nothing"


class Attack:
    """An object whose pickle makes a folder."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __reduce__(self) -> tuple[Callable[..., object], tuple[str]]:
        return os.mkdir, (self.folder,)


def _of_dask_family(pickled: bytes) -> Serialized:
    """A value in the format for known types, whose type is the pickle."""
    header = {"serializer": "dask", "type-serialized": pickled, "sub-header": {}, "type": "builtins.bytes"}
    return Serialized(header, [b""])


def _of_pickle_family(pickled: bytes) -> Serialized:
    return Serialized({"serializer": "pickle", "writeable": ()}, [pickled])


class Scheduler:
    """attack: which answer holds a pickle; see ATTACKS.  text: of the honest answers to tasks."""

    def __init__(self, attack: str, folder: str, text: str) -> None:
        self.attack, self.text = attack, text
        self.hostile = Attack(folder)
        self.pickled = pickle.dumps(self.hostile)
        self.error = {"exception": Serialize(self.pickled), "traceback": Serialize(self.pickled)}

    async def serve(self, comm: Comm) -> None:
        try:
            while True:
                await self._answer(comm, await comm.read())
        except CommClosedError:
            return

    async def _answer(self, comm: Comm, messages: Any) -> None:
        for message in messages if isinstance(messages, list | tuple) else (messages,):
            operation = message["op"]
            if operation == "register-client":
                begun: dict[str, object] = {"op": "stream-start"}
                await comm.write([self._with("stream", begun)])
            elif operation == "update-graph":
                await comm.write(self._about_task(message["keys"]))
            elif message.get("reply"):
                await comm.write(self._reply(operation, message))

    def _with(self, attack: str, message: dict[str, object]) -> dict[str, object]:
        return {**message, "more": ToPickle(self.hostile)} if self.attack == attack else message

    def _reply(self, operation: str, message: dict[str, Any]) -> object:
        if operation == "identity":
            return self._with("identity", {"type": "Scheduler", "id": "one", "address": "", "workers": {}})
        if operation == "ncores":
            if self.attack == "uncaught error":
                return {"status": "uncaught-error", **self.error, "exception_text": "", "traceback_text": ""}
            return {WORKER: 1}
        if operation == "broadcast":
            return {WORKER: self._of_worker()}
        if operation == "gather":
            return {"status": "OK", "data": {key: self._result() for key in message["keys"]}}
        return {"status": "OK"}

    def _of_worker(self) -> object:
        if self.attack == "failure of a worker":
            return self.pickled
        if self.attack == "error of a worker":
            return {"status": "error", **self.error}
        if self.attack == "description":
            return {"status": "OK", "result": _of_pickle_family(self.pickled)}
        told = json.dumps({"software": software(), "problem": None})
        return {"status": "OK", "result": told}

    def _about_task(self, keys: list[Any]) -> list[dict[str, object]]:
        told: list[dict[str, object]] = []
        if self.attack == "warning":
            event = (0, {"message": self.pickled, "category": self.pickled})
            told.append({"op": "event", "topic": "warn", "event": event})
        for key in keys:
            if self.attack == "error of a task":
                told.append({"op": "task-erred", "key": key, **self.error})
            else:
                kind = self.pickled if self.attack == "type of a result" else None
                ready = {"op": "key-in-memory", "key": key, "type": kind, "workers": [WORKER]}
                told.append(self._with("message about a task", ready))
        return told

    def _result(self) -> object:
        if self.attack == "result":
            return _of_pickle_family(self.pickled)
        if self.attack == "result of a known type":
            return _of_dask_family(self.pickled)
        if self.attack == "object in a result":
            return ToPickle(self.hostile)
        return self.text


ATTACKS: Final = (
    "handshake", "identity", "stream", "uncaught error", "failure of a worker", "error of a worker",
    "description", "warning", "message about a task", "error of a task", "type of a result", "result",
    "result of a known type", "object in a result",
)  # fmt: skip


async def main(attack: str, folder: str, text: str = "") -> None:
    scheduler = Scheduler(attack, folder, text)
    if attack == "handshake":
        honest = Comm.handshake_info

        def handshake_info(self: Comm) -> dict[str, object]:
            return {**honest(self), "more": ToPickle(scheduler.hostile)}

        Comm.handshake_info = handshake_info  # type: ignore[method-assign]
    listener = await listen("tcp://127.0.0.1:0", scheduler.serve, deserialize=False)
    sys.stdout.write(f"{listener.contact_address}\n")
    sys.stdout.flush()
    await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
