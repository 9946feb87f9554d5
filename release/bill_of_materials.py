"""The bill of materials (SBOM): every package that the image installs, with its hashes, as CycloneDX JSON.

The build of the wheel calls this (setup.py), so it needs nothing but Python. The same pins give the same
bill: it has no time and no serial number.
"""

import json
import tomllib
from collections.abc import Sequence
from pathlib import Path

from release.pins import Pin, read_pins

NAME = "bill_of_materials.cdx.json"
"""In the wheel it lies in the package `service`."""

SPECIFICATION = "1.6"


def bill_of_materials(root: Path) -> str:
    """Return the bill of a source tree. Raises OSError, PinError."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return json.dumps(_document(project, read_pins(root / "requirements.txt")), indent=1) + "\n"


def _document(project: dict[str, str], pins: Sequence[Pin]) -> dict[str, object]:
    own = _package_url(project["name"], project["version"])
    return {
        "$schema": f"http://cyclonedx.org/schema/bom-{SPECIFICATION}.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": SPECIFICATION,
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": own,
                "name": project["name"],
                "version": project["version"],
                "description": project["description"],
                "licenses": [{"expression": project["license"]}],
                "purl": own,
            }
        },
        "components": [_component(pin) for pin in pins],
        "dependencies": [
            {"ref": own, "dependsOn": [_package_url(pin.name, pin.version) for pin in pins]},
            *({"ref": _package_url(pin.name, pin.version)} for pin in pins),
        ],
    }


def _component(pin: Pin) -> dict[str, object]:
    address = _package_url(pin.name, pin.version)
    return {
        "type": "library",
        "bom-ref": address,
        "name": pin.name,
        "version": pin.version,
        "purl": address,
        "externalReferences": [
            {
                "type": "distribution",
                "url": f"https://pypi.org/project/{pin.name}/{pin.version}/",
                "hashes": [{"alg": "SHA-256", "content": digest} for digest in pin.sha256],
            }
        ],
    }


def _package_url(name: str, version: str) -> str:
    return f"pkg:pypi/{name}@{version}"
