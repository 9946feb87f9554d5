"""`python -m release advisories | audit | site`: fetch advisories; look for them in pins; make help pages."""

import json
import sys
import tomllib
from datetime import UTC, datetime
from pathlib import Path

import httpx

from release.advisories import AdvisoryError, affected, fetch, read
from release.help_site import FOLDER, HelpSiteError, build
from release.pins import read_pins

ROOT = Path(__file__).parents[1]
FILE = ROOT / "advisories.json"
PINNED = ("constraints.txt", "requirements.txt")


def main(command: str) -> int:
    """Return the exit code: 0 where all is well."""
    if command == "site":
        return _site()
    pins = [pin for name in PINNED for pin in read_pins(ROOT / name)]
    pins = list({(pin.name, pin.version): pin for pin in pins}.values())
    try:
        if command == "advisories":
            with httpx.Client() as client:
                document = fetch(pins, client, datetime.now(UTC))
            FILE.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
            print(f"{FILE.name}: advisories about {len(pins)} packages")
            return 0
        found = affected(pins, read(FILE, datetime.now(UTC)), accepted())
    except AdvisoryError as error:
        print(f"audit: {error}", file=sys.stderr)
        return 1
    for one in found:
        print(f"audit: {one}", file=sys.stderr)
    print(f"{len(pins)} packages, {len(found)} known advisories")
    return 1 if found else 0


def _site() -> int:
    try:
        build(ROOT, ROOT / FOLDER)
    except HelpSiteError as error:
        print(f"site: {error}", file=sys.stderr)
        return 1
    return 0


def accepted() -> dict[str, str]:
    """Why advisories do not concern us, by their ids."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    accepted: dict[str, str] = project["tool"]["statorwatch"]["accepted-advisories"]
    return accepted


if __name__ == "__main__":
    if sys.argv[1:] not in (["advisories"], ["audit"], ["site"]):
        sys.exit("usage: python -m release advisories | audit | site")
    sys.exit(main(sys.argv[1]))
