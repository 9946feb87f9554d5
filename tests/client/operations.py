"""Writes the client's functions, one for each operation of an OpenAPI document."""

import keyword
import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

JSON = "application/json"
RAW = {"text/plain": "text", "application/octet-stream": "content"}
"""What is sent as it is, and what its argument is called."""
TIMES = ({"date-time"}, {"date-time", "date"}, {"date"})
SCALARS = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}
FOLLOWED = ("cursor",)
WIDTH = 100

HEADER = '''"""The functions of {the_client}, one for each route."""

from __future__ import annotations

from collections.abc import {Iterator}, Mapping, Sequence
from contextlib import {manager}
from typing import TYPE_CHECKING, Any, Literal

from statorwatch_client.requests import Request, Time, segment

if TYPE_CHECKING:
    from statorwatch_client import models
    from statorwatch_client.{module} import {Download}


class {Operations}:
    """What a service can be asked. The class that inherits this one sends the requests."""

    {a}def _document(self, request: Request) -> Any:
        """Return the document that answers."""
        raise NotImplementedError

    {a}def _new_document(self, request: Request) -> tuple[Any, bool]:
        """Return the document that answers, and whether what it tells of is new."""
        raise NotImplementedError

    {a}def _done(self, request: Request) -> None:
        """Send what is answered without a document."""
        raise NotImplementedError

    def _items(self, request: Request) -> {Iterator}[Any]:
        """Yield the items of a list, page after page."""
        raise NotImplementedError

    def _file(self, request: Request) -> {manager}[{Download}]:
        """Return the file that answers, while it comes."""
        raise NotImplementedError
'''


@dataclass(frozen=True)
class Argument:
    """One argument of a function: its name there and in the request, its type, and what it is."""

    name: str
    sent_as: str
    kind: str
    words: str
    is_required: bool


class Writer:
    """Writes the functions of one document, for one of the two clients."""

    def __init__(self, document: Mapping[str, Any], *, asynchronous: bool) -> None:
        self._schemas = document["components"]["schemas"]
        self._paths = document["paths"]
        self._a, self._wait = ("async ", "await ") if asynchronous else ("", "")
        self._iterator = "AsyncIterator" if asynchronous else "Iterator"
        self._manager = f"Abstract{'Async' if asynchronous else ''}ContextManager"
        self._download = "AsyncDownload" if asynchronous else "Download"

    def module(self) -> str:
        """Return the whole module."""
        prefix = "Async" if self._a else ""
        header = HEADER.format(
            a=self._a,
            the_client=f"{prefix}Client",
            Iterator=self._iterator,
            manager=self._manager,
            module=f"{prefix.lower()}_client".lstrip("_"),
            Download=self._download,
            Operations=f"{prefix}Operations",
        )
        functions = [
            function
            for path, methods in self._paths.items()
            for method, operation in methods.items()
            for function in self._functions(path, method.upper(), operation)
        ]
        return "\n".join([header, *(textwrap.indent(one, "    ") for one in functions)])

    def _functions(self, path: str, method: str, operation: Mapping[str, Any]) -> Iterator[str]:
        answers = {int(code): one for code, one in operation["responses"].items() if code.startswith("2")}
        kinds = {kind for one in answers.values() for kind in one.get("content", {})}
        schema = next(
            (one["content"][JSON]["schema"] for one in answers.values() if JSON in one.get("content", {})),
            None,
        )
        if schema is not None or not kinds:
            yield self._function(path, method, operation, schema, is_maybe_new={200, 201} <= answers.keys())
        if kinds - {JSON}:
            yield self._file_function(path, method, operation, is_of_page=schema is not None)

    def _function(
        self,
        path: str,
        method: str,
        operation: Mapping[str, Any],
        schema: Mapping[str, Any] | None,
        *,
        is_maybe_new: bool,
    ) -> str:
        query = [one for one in self._query(operation) if one.sent_as != "format"]
        request = self._request(path, method, operation, query)
        if schema is None:
            return self._written(
                path, operation, query, "None", f"{self._wait}self._done({request})", self._a
            )
        kind = self._kind(schema)
        item = self._item_of_page(schema)
        if item is not None:
            if method != "GET":  # what changes something is sent at once, not when its answer is looked at
                loop = (
                    f"[one async for one in self._items({request})]"
                    if self._a
                    else f"list(self._items({request}))"
                )
                return self._written(path, operation, query, f"list[{item}]", f"return {loop}", self._a)
            answer = f"{self._iterator}[{item}]"
            return self._written(path, operation, query, answer, f"return self._items({request})", "")
        asked = "_new_document" if is_maybe_new else "_document"
        kind = f"tuple[{kind}, bool]" if is_maybe_new else kind
        body = f"answer: {kind} = {self._wait}self.{asked}({request})\nreturn answer"
        more = "The second value tells whether it is new." if is_maybe_new else ""
        return self._written(path, operation, query, kind, body, self._a, more=more)

    def _file_function(
        self, path: str, method: str, operation: Mapping[str, Any], *, is_of_page: bool
    ) -> str:
        query = self._query(operation)
        name = operation["operationId"]
        if is_of_page:  # a file has the whole list
            name += "_file"
            query = [self._of_file(one) for one in query if one.sent_as not in ("limit", "cursor")]
        request = self._request(path, method, operation, query)
        answer = f"{self._manager}[{self._download}]"
        more = "The answer is a file, which is read inside a `with` statement."
        body = f"return self._file({request})"
        return self._written(path, {**operation, "operationId": name}, query, answer, body, "", more=more)

    @staticmethod
    def _of_file(one: Argument) -> Argument:
        if one.sent_as != "format":
            return one
        kind = re.sub(r"'json', | \| None", "", one.kind)
        return Argument(one.name, one.sent_as, kind, "What kind of file it is to be.", is_required=True)

    def _written(
        self,
        path: str,
        operation: Mapping[str, Any],
        query: list[Argument],
        answer: str,
        body: str,
        a: str,
        *,
        more: str = "",
    ) -> str:
        named = [*query, *self._headers(operation)]
        before = [*self._path_arguments(path), *self._body(operation)]
        first = [f"{one.name}: {one.kind}{'' if one.is_required else ' = None'}" for one in before]
        last = [f"{one.name}: {one.kind}{'' if one.is_required else ' = None'}" for one in named]
        arguments = ", ".join(["self", *first, *(["*", *last] if last else [])])
        words = [operation.get("description") or operation["summary"], *([more] if more else [])]
        told = "\n\n".join(words)
        parameters = "".join(
            f"{one.name}\n{textwrap.indent(textwrap.fill(one.words, WIDTH), '    ')}\n"
            for one in [*before, *named]
        )
        if parameters:
            told += f"\n\nParameters\n----------\n{parameters}"
        quoted = f'r"""{told}"""' if "\\" in told else f'"""{told}"""'
        return f"{a}def {operation['operationId']}({arguments}) -> {answer}:\n" + textwrap.indent(
            f"{quoted}\n{body}\n", "    "
        )

    def _request(self, path: str, method: str, operation: Mapping[str, Any], query: list[Argument]) -> str:
        names = {f"{{{one.sent_as}}}": f"{{segment({one.name})}}" for one in self._path_arguments(path)}
        filled = path
        for sent, written in names.items():
            filled = filled.replace(sent, written)
        parts = [repr(method), f"{'f' if names else ''}{filled!r}"]
        if query:
            pairs = ", ".join(f"{one.sent_as!r}: {one.name}" for one in query)
            parts.append(f"query={{{pairs}}}")
        headers = [f"{one.sent_as!r}: {one.name}" for one in self._headers(operation)]
        content = self._content(operation)
        if content in RAW:
            headers.append(f"'Content-Type': {content!r}")
            parts.append(f"content={RAW[content]}")
        elif content == JSON:
            parts.append("json=document")
        elif content is not None:
            form = [one for one in self._body(operation) if one.name != "files"]
            parts.append(f"form={{{', '.join(f'{one.sent_as!r}: {one.name}' for one in form)}}}, files=files")
        if headers:
            parts.append(f"headers={{{', '.join(headers)}}}")
        return f"Request({', '.join(parts)})"

    @staticmethod
    def _path_arguments(path: str) -> list[Argument]:
        """Return the names of a path. That of a motor is `motor`, whatever the document calls it."""
        found = []
        for collection, sent_as in re.findall(r"([\w-]+)/\{(\w+)\}", path):
            singular = collection.removesuffix("s").replace("-", "_")
            name = singular if sent_as == "name" else sent_as
            words = (
                f"Name of the {singular.replace('_', ' ')}."
                if sent_as == "name"
                else "As a document tells it."
            )
            found.append(Argument(name, sent_as, "str", words, is_required=True))
        return found

    def _query(self, operation: Mapping[str, Any]) -> list[Argument]:
        return self._parameters(operation, "query")

    def _headers(self, operation: Mapping[str, Any]) -> list[Argument]:
        return self._parameters(operation, "header")

    def _parameters(self, operation: Mapping[str, Any], where: str) -> list[Argument]:
        found = [
            self._parameter(one)
            for one in operation.get("parameters", ())
            if one["in"] == where and one["name"] not in FOLLOWED
        ]
        return sorted(found, key=lambda one: not one.is_required)

    def _parameter(self, one: Mapping[str, Any]) -> Argument:
        name = one["name"].replace("-", "_")
        if keyword.iskeyword(name):
            name += "_"
        kind = self._kind(one["schema"]).replace("list[", "Sequence[")
        is_required = bool(one.get("required"))
        if not is_required and not kind.endswith("| None"):
            kind += " | None"
        words = one.get("description") or f"`{one['name']}` of the request."
        if one["name"] == "limit":
            words = "Most items that are asked for at once; the list goes on all the same."
        default = one["schema"].get("default")
        if default is not None:
            words += f" Without: {str(default).lower() if isinstance(default, bool) else default}."
        return Argument(name, one["name"], kind, words, is_required)

    @staticmethod
    def _content(operation: Mapping[str, Any]) -> str | None:
        return next(iter(operation.get("requestBody", {}).get("content", {})), None)

    def _body(self, operation: Mapping[str, Any]) -> list[Argument]:
        content = self._content(operation)
        if content is None:
            return []
        schema = operation["requestBody"]["content"][content]["schema"]
        if content == JSON:
            is_required = bool(operation["requestBody"].get("required"))
            kind = self._kind(schema)
            return [Argument("document", "document", kind, "What is sent.", is_required)]
        if content in RAW:
            name = RAW[content]
            return [Argument(name, name, "bytes", schema["description"], is_required=True)]
        fields = self._schemas[schema["$ref"].rpartition("/")[2]]["properties"]
        return [
            Argument(
                name,
                name,
                "Mapping[str, bytes]" if name == "files" else "str",
                one["description"] + (" By their names." if name == "files" else ""),
                is_required=True,
            )
            for name, one in fields.items()
        ]

    def _item_of_page(self, schema: Mapping[str, Any]) -> str | None:
        properties = self._schemas.get(schema.get("$ref", "").rpartition("/")[2], {}).get("properties", {})
        if properties.keys() != {"items", "next_cursor"}:
            return None
        return self._kind(properties["items"]["items"])

    def _kind(self, schema: Mapping[str, Any]) -> str:
        """Return the Python type of what a schema allows."""
        if "$ref" in schema:
            return f"models.{schema['$ref'].rpartition('/')[2]}"
        if "anyOf" in schema:
            formats = {one.get("format") for one in schema["anyOf"]} - {None}
            kinds = [self._kind(one) for one in schema["anyOf"]]
            if formats and formats in TIMES:
                kinds = ["Time", *(kind for kind in kinds if kind == "None")]
            return " | ".join(dict.fromkeys(kinds))
        if "enum" in schema or "const" in schema:
            return f"Literal[{', '.join(map(repr, schema.get('enum') or [schema['const']]))}]"
        if schema.get("format") in ("date-time", "date"):
            return "Time"
        if schema.get("type") == "array":
            return f"list[{self._kind(schema['items'])}]"
        if schema.get("type") in SCALARS:
            return SCALARS[schema["type"]]
        raise ValueError(f"no Python type is known for {schema}")


def operations_module(document: Mapping[str, Any], *, asynchronous: bool) -> str:
    """Return the source of the functions of the client, or of the one for asyncio."""
    return Writer(document, asynchronous=asynchronous).module()
