"""The image as the Dockerfile describes it, read by a parser."""

import json
import shlex
from typing import cast

from dockerfile_parse import DockerfileParser

from tests.deployment.composing import ROOT

DOCKERFILE = DockerfileParser(path=str(ROOT / "Dockerfile"))


def instructions(keyword: str) -> list[str]:
    """What stands behind each instruction of this keyword, on one line and in the order of the file."""
    return [
        str(instruction["value"])
        for instruction in DOCKERFILE.structure
        if instruction["instruction"] == keyword
    ]


def base_images() -> list[str]:
    return list(DOCKERFILE.parent_images)


def commands_running(*words: str) -> list[list[str]]:
    """The words of each shell command of a RUN that contains these words in a row."""
    found = []
    for line in instructions("RUN"):
        for command in line.split("&&"):
            split = shlex.split(command)
            if any(tuple(split[k : k + len(words)]) == words for k in range(len(split))):
                found.append(split)
    return found


def health_check() -> list[str]:
    """The command that tells whether a container is well."""
    (check,) = instructions("HEALTHCHECK")
    return cast(list[str], json.loads(check.partition(" CMD ")[2]))
