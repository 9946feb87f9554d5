"""Writes `statorwatch_client/operations.py`: a method for each operation of the API.

The models are made by a library. Of those that make methods too, openapi-python-client makes two modules for
each operation, 300 in all; one class with a method for each is what people read and complete.
"""

import builtins
import keyword
import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

from testing.api_client.document import Json

PREFIX = "/api/v1"
PAGE = re.compile(r"Page_(\w+)_$")
HEAD = '''"""Every operation of the API as a method. Made by `make client`; not to be edited."""

# ruff: noqa: E501
from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO, Literal, cast

from statorwatch_client.transport import Transport, segment

if TYPE_CHECKING:  # types alone, which need not be made at each start of a program
    from collections.abc import Iterator, Mapping, Sequence
    from datetime import datetime

    from statorwatch_client import models


class Operations:
    """The operations of the API. Each raises ServiceError where the service does not do what it is asked.

    Parameters
    ----------
    transport : Transport
        Sends the requests.
    """

    def __init__(self, transport: Transport) -> None:
        self.transport = transport
'''
LINE = 100


@dataclass(frozen=True)
class Argument:
    """An argument of a method.

    sent: its name in the request.  place: "path", "query", "header", "form", "files", "json" or "text".
    """

    name: str
    sent: str
    kind: str
    place: str
    required: bool
    told: str


def operations_module(document: Json) -> str:
    methods = [
        method
        for path, operations in document["paths"].items()
        if path.startswith(PREFIX)
        for verb, operation in operations.items()
        for method in _methods(verb.upper(), path, operation)
    ]
    return "\n".join([HEAD, *methods])


def _methods(verb: str, path: str, operation: Json) -> Iterator[str]:
    name = operation["operationId"]
    arguments = [*_parameters(operation), *_body(operation)]
    answers = [answer for status, answer in operation["responses"].items() if status.startswith("2")]
    kinds = {kind for answer in answers for kind in answer.get("content", {})}
    schema = next(
        (
            content["schema"]
            for answer in answers
            for kind, content in answer.get("content", {}).items()
            if kind == "application/json" and "$ref" in content.get("schema", {})
        ),
        None,
    )
    told = operation.get("description") or operation["summary"] + "."
    call = _call(path, arguments)
    if schema is not None:
        # Lists come as files too where one asks for that; the exports are what files are for.
        arguments = [argument for argument in arguments if argument.sent != "format"]
        call = _call(path, arguments)
        model = python_name(schema["$ref"])
        several = len(answers) > 1
        yield _method(
            name,
            arguments,
            f"tuple[int, {model}]" if several else model,
            told,
            _several(verb, call, model)
            if several
            else f'return cast("{model}", self.transport.document("{verb}", {call}))',
            "HTTP status and document." if several else "The document.",
        )
        page = PAGE.search(schema["$ref"])
        if page and any(argument.name == "cursor" for argument in arguments):
            yield _iterator(name, arguments, f"models.{page[1]}", told, call.split(", ")[0])
    elif not kinds:
        yield _method(name, arguments, "None", told, f'self.transport.document("{verb}", {call})', None)
    elif kinds == {"application/jsonl"}:
        code = f"return self.transport.lines({call})"
        yield _method(name, arguments, "Iterator[str]", told, code, "The lines, while they come.")
    else:
        sink = Argument("sink", "", "BinaryIO", "sink", required=True, told="Takes the file.")
        address, *others = call.split(", ", 1)
        code = f"return self.transport.save({', '.join([address, 'sink', *others])})"
        yield _method(name, [*arguments, sink], "int", told, code, "Size of the file [bytes].")


def _several(verb: str, call: str, model: str) -> str:
    return (
        f'answer = self.transport.answer("{verb}", {call})\n'
        f'return answer.status_code, cast("{model}", answer.json())'
    )


def _iterator(name: str, arguments: list[Argument], item: str, told: str, address: str) -> str:
    following = [argument for argument in arguments if argument.name != "cursor"]
    given = ", ".join(
        argument.name if argument.place == "path" else f"{argument.name}={argument.name}"
        for argument in following
    )
    code = (
        "cursor: str | None = None\n"
        "while True:\n"
        f"    page = self.{name}({given + ', ' if given else ''}cursor=cursor)\n"
        f"    yield from self.transport.listed(page, {address})\n"
        '    cursor = page.get("next_cursor")\n'
        "    if cursor is None:\n"
        "        return"
    )
    plural = re.sub(r"^(list|get)_", "iter_", name)
    return _method(
        plural, following, f"Iterator[{item}]", told, code, "Every item, page after page.", "Yields"
    )


def _method(
    name: str,
    arguments: list[Argument],
    answer: str,
    told: str,
    code: str,
    returns: str | None,
    title: str = "Returns",
) -> str:
    first = [argument for argument in arguments if argument.place in ("path", "sink")]
    others = sorted((each for each in arguments if each not in first), key=lambda each: not each.required)
    signature = ["self", *(f"{each.name}: {each.kind}" for each in first)]
    if others:
        signature.append("*")
    signature += [
        f"{each.name}: {each.kind}" if each.required else f"{each.name}: {each.kind} | None = None"
        for each in others
    ]
    text = [*_paragraph(told), ""]
    if first or others:
        text += ["Parameters", "----------"]
        for each in [*first, *others]:
            kind = each.kind.replace("models.", "")
            text += [
                f"{each.name} : {kind if each.required else kind + ' or None'}",
                *textwrap.wrap(each.told, LINE - 12, initial_indent="    ", subsequent_indent="    "),
            ]
        text.append("")
    if returns is not None:
        text += [title, "-" * len(title), _answered(answer).replace("models.", ""), f"    {returns}", ""]
    text += ["Raises", "------", "ServiceError", "    Nothing answers, or the service refuses."]
    lines = [
        f"def {name}({', '.join(signature)}) -> {answer}:",
        *_indented(['"""' + text[0], *text[1:], '"""']),
    ]
    return "\n".join(_indented([*lines, *_indented(code.splitlines())])) + "\n"


def _answered(answer: str) -> str:
    inner = re.fullmatch(r"Iterator\[(.*)\]", answer)
    return inner[1] if inner else answer


def _paragraph(told: str) -> list[str]:
    """Return a description as it may stand in a docstring: a line, and what follows it."""
    clean = " ".join(told.replace("\\", "\\\\").replace('"""', "'''").split())
    sentence, _, rest = clean.partition(". ")
    first = sentence.rstrip(".") + "."
    return [first, *(["", *textwrap.wrap(rest, LINE)] if rest else [])]


def _indented(lines: list[str]) -> list[str]:
    return [f"    {line}" if line else "" for line in lines]


def _call(path: str, arguments: list[Argument]) -> str:
    """Return what the transport is given: the path, and what else is sent."""
    address = path
    for argument in arguments:
        if argument.place == "path":
            address = address.replace(f"{{{argument.sent}}}", f"{{segment({argument.name})}}")
    given = [f'f"{address}"' if "{" in address else f'"{address}"']
    for place, word in (("query", "query"), ("header", "headers"), ("form", "form")):
        sent = [each for each in arguments if each.place == place]
        if sent:
            fields = ", ".join(f'"{each.sent}": {each.name}' for each in sent)
            given.append(f"{word}={{{fields}}}")
    for place in ("files", "json", "text"):
        given += [f"{place}={each.name}" for each in arguments if each.place == place]
    return ", ".join(given)


def _parameters(operation: Json) -> Iterator[Argument]:
    for each in operation.get("parameters", ()):
        schema = each["schema"]
        yield Argument(
            _variable(each["name"]),
            each["name"],
            python_type(schema),
            each["in"],
            required=each["in"] == "path" or each.get("required", False),
            told=_told(each, schema),
        )


def _body(operation: Json) -> Iterator[Argument]:
    body = operation.get("requestBody")
    if body is None:
        return
    (kind, content), *_ = body["content"].items()
    required = body.get("required", False)
    if kind == "application/json":
        schema = content["schema"]
        yield Argument("document", "", python_type(schema), "json", required, "What is wanted.")
    elif kind == "text/plain":
        yield Argument("text", "", "bytes", "text", required=True, told="The text that is sent.")
    else:
        yield Argument("motor", "motor", "str", "form", required=True, told="The motor.")
        files = "Contents of the files, by name."
        yield Argument("files", "files", "Mapping[str, bytes]", "files", required=True, told=files)


def _told(parameter: Json, schema: Json) -> str:
    told = parameter.get("description") or schema.get("description")
    if told:
        return f"{told[0].upper()}{told[1:]}"
    name = str(parameter["name"])
    return "Its name." if name == "name" else name.replace("_", " ").capitalize() + "."


def _variable(name: str) -> str:
    word = name.replace("-", "_")
    return f"{word}_" if keyword.iskeyword(word) or hasattr(builtins, word) else word


def python_name(reference: str) -> str:
    """Return the class that the models have for a schema."""
    return "models." + reference.rsplit("/", 1)[-1].replace("_", "")


def python_type(schema: Json) -> str:
    """Return the type of a parameter. Raises ValueError for one that no parameter has had so far."""
    if "$ref" in schema:
        return python_name(schema["$ref"])
    for several in ("anyOf", "oneOf", "allOf"):
        if several in schema:
            kinds = [python_type(each) for each in schema[several] if each.get("type") != "null"]
            return " | ".join(dict.fromkeys(" | ".join(kinds).split(" | ")))
    if "enum" in schema:
        return f"Literal[{', '.join(repr(each) for each in schema['enum'])}]".replace("'", '"')
    match schema.get("type"):
        case "string":
            return "datetime | str" if schema.get("format") == "date-time" else "str"
        case "integer":
            return "int"
        case "number":
            return "float"
        case "boolean":
            return "bool"
        case "array":
            return f"Sequence[{python_type(schema['items'])}]"
    raise ValueError(f"a parameter of another kind: {schema}")
