"""Known advisories about the pinned packages: fetched where there is a network, compared where there is none.

The file has every advisory of OSV (osv.dev, which has those of PyPI and GitHub) about a package that
constraints.txt or requirements.txt names, with the versions that it concerns. So it also says of another pin
whether it is affected.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Final

import httpx
from packaging.version import InvalidVersion, Version

from release.pins import Pin, normalised

ADDRESS: Final = "https://api.osv.dev/v1/query"
TIMEOUT_S: Final = 30.0
OLDEST: Final = timedelta(days=30)
"""Older files miss too much: advisories come each week."""

REMAKE: Final = "make it anew where there is a network: make advisories"


class AdvisoryError(RuntimeError):
    """The advisories cannot be had, or say nothing of today."""


@dataclass(frozen=True, slots=True)
class Affected:
    """A pinned package that an advisory concerns."""

    pin: Pin
    advisory: str
    summary: str
    fixed: tuple[str, ...]

    def __str__(self) -> str:
        """Return it as one line."""
        fixed = f"fixed in {', '.join(self.fixed)}" if self.fixed else "no version is fixed"
        return f"{self.pin.name} {self.pin.version}: {self.advisory}, {fixed}: {self.summary}"


def fetch(pins: Sequence[Pin], client: httpx.Client, now: datetime) -> dict[str, object]:
    """Ask for the advisories of each package. Raises AdvisoryError."""
    packages = {}
    for pin in pins:
        try:
            packages[pin.name] = list(_of_package(pin.name, client))
        except (httpx.HTTPError, ValueError, KeyError) as error:
            raise AdvisoryError(
                f"{ADDRESS}: expected advisories about {pin.name}, found: {type(error).__name__}: {error}"
            ) from error
    return {"made": now.isoformat(timespec="seconds"), "source": ADDRESS, "packages": packages}


def _of_package(name: str, client: httpx.Client) -> Iterator[dict[str, object]]:
    question: dict[str, object] = {"package": {"name": name, "ecosystem": "PyPI"}}
    while True:
        answer = client.post(ADDRESS, json=question, timeout=TIMEOUT_S).raise_for_status().json()
        for one in answer.get("vulns", ()):
            if "withdrawn" not in one:
                yield {
                    "id": one["id"],
                    "aliases": one.get("aliases", []),
                    "summary": one.get("summary") or one.get("details", "")[:200],
                    "affected": [
                        {"ranges": _ranges(each), "versions": each.get("versions", [])}
                        for each in one.get("affected", ())
                        if normalised(each.get("package", {}).get("name", "")) == name
                    ],
                }
        if not answer.get("next_page_token"):
            return
        question["page_token"] = answer["next_page_token"]


def _ranges(affected: Mapping[str, Any]) -> list[object]:
    return [each["events"] for each in affected.get("ranges", ()) if each.get("type") == "ECOSYSTEM"]


def read(path: Path, now: datetime) -> Mapping[str, Any]:
    """Return a file that `fetch` has made. Raises AdvisoryError where it says nothing of today."""
    try:
        document: Mapping[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        made = datetime.fromisoformat(document["made"]).astimezone(UTC)
    except FileNotFoundError as error:
        raise AdvisoryError(f"{path}: expected known advisories, found no file; {REMAKE}") from error
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise AdvisoryError(f"{path}: expected known advisories, found: {error}; {REMAKE}") from error
    if now - made > OLDEST:
        raise AdvisoryError(
            f"{path}: expected advisories of the last {OLDEST.days} days, "
            f"found those of {made:%Y-%m-%d}; {REMAKE}"
        )
    return document


def affected(
    pins: Sequence[Pin], document: Mapping[str, Any], accepted: Mapping[str, str]
) -> Sequence[Affected]:
    """Return what concerns the pins. accepted: why an advisory does not concern us, by its id or an alias.

    Raises AdvisoryError where the document does not know a package.
    """
    unknown = [pin.name for pin in pins if pin.name not in document["packages"]]
    if unknown:
        raise AdvisoryError(f"advisories: nothing is known of {', '.join(unknown)}; {REMAKE}")
    return [
        Affected(pin, one["id"], one["summary"], tuple(_fixed(one)))
        for pin in pins
        for one in document["packages"][pin.name]
        if not accepted.keys() & {one["id"], *one["aliases"]} and _concerns(one, pin.version)
    ]


def _concerns(advisory: Mapping[str, Any], pinned: str) -> bool:
    return any(
        pinned in each["versions"] or any(_is_within(events, pinned) for events in each["ranges"])
        for each in advisory["affected"]
    )


def _is_within(events: Sequence[Mapping[str, str]], pinned: str) -> bool:
    """Tell whether a version lies in a range of OSV: its events in order begin and end what is affected."""
    version, is_affected = Version(pinned), False
    for event in events:
        for word, text in event.items():
            try:
                at = Version(text)
            except InvalidVersion:  # of an old package: its versions are listed besides
                continue
            if word == "introduced" and version >= at:
                is_affected = True
            elif (word == "fixed" and version >= at) or (word == "last_affected" and version > at):
                is_affected = False
    return is_affected


def _fixed(advisory: Mapping[str, Any]) -> Iterator[str]:
    for each in advisory["affected"]:
        for events in each["ranges"]:
            yield from (event["fixed"] for event in events if "fixed" in event)
