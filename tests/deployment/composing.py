"""A compose command (docker compose, podman-compose), driven the way a person would: by its verbs alone."""

import json
import os
import re
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROJECT = "statorwatch-test"
LIMIT_S = 300.0
BUILD_LIMIT_S = 1200.0


class ComposeError(RuntimeError):
    """The command failed; its words are in the message."""


class Compose:
    """The compose file in a project of its own, beside any that runs; the API on `port` of the host.

    laid_over: further compose files, which add to it or change it.  variables: those that these ask for.
    """

    def __init__(self, command: str, port: int, laid_over: Sequence[str] = (), **variables: str) -> None:
        files = [word for file in ("docker-compose.yml", *laid_over) for word in ("-f", str(ROOT / file))]
        self._command = [*shlex.split(command), *files, "-p", PROJECT]
        self.port = port
        self._environment = {**os.environ, "MCC_HOST_PORT": str(port), **variables}

    def __call__(self, *arguments: str, limit_s: float = LIMIT_S) -> str:
        """Run a verb; returns what it printed. Raises ComposeError."""
        ended = self.attempt(*arguments, limit_s=limit_s)
        if ended.returncode:
            raise ComposeError(f"{' '.join(arguments)}: exit code {ended.returncode}\n{ended.stdout[-4000:]}")
        return ended.stdout

    def attempt(self, *arguments: str, limit_s: float = LIMIT_S) -> "subprocess.CompletedProcess[str]":
        """Run a verb that may fail; what it printed on both streams is in `stdout`."""
        return self._run([*self._command, *arguments], ROOT, limit_s)

    def follow(self, script: str, directory: Path | str) -> str:
        """Run shell lines as a page has them; this command is their `docker compose`. Raises ComposeError."""
        command = shlex.join(self._command)
        meant = f'docker() {{ [ "$1" = compose ] && shift && {command} "$@"; }}\nset -e\n{script}'
        ended = self._run(["sh", "-c", meant], directory, LIMIT_S)
        if ended.returncode:
            raise ComposeError(f"{script}\nexit code {ended.returncode}\n{ended.stdout[-4000:]}")
        return ended.stdout

    def _run(
        self, command: Sequence[str], directory: Path | str, limit_s: float
    ) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(
            command,
            cwd=directory,
            env=self._environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=limit_s,
            check=False,
        )

    def containers(self) -> list[str]:
        """Identifiers of the project's containers."""
        return re.findall(r"^[0-9a-f]{12,64}$", self("ps", "-q"), re.MULTILINE)

    def inside(self, service: str, *command: str) -> str:
        """What a command prints in a running container."""
        return self("exec", "-T", service, *command)

    def once(self, service: str, *command: str) -> str:
        """What a command prints in a container of its own."""
        return self("run", "--rm", "-T", "--no-deps", service, *command)

    def document(self, service: str, *command: str) -> Mapping[str, object]:
        """The JSON document a command prints in a container of its own; some tools print lines around it."""
        printed = "\n" + self.once(service, *command)
        try:
            found, _ = json.JSONDecoder().raw_decode(printed[printed.index("\n{\n") + 1 :])
        except ValueError as error:
            raise ComposeError(f"{' '.join(command)}: expected a JSON document, found:\n{printed}") from error
        assert isinstance(found, dict)
        return found
