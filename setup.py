"""The build of the wheel, beside pyproject.toml: it puts the bill of materials into the package `service`."""

import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).parent
sys.path.insert(0, str(ROOT))  # a build front end does not

from release.bill_of_materials import NAME, bill_of_materials  # noqa: E402 - needs the path


class BuildWithBill(build_py):
    """Copy the packages, and write the bill of materials beside them."""

    def run(self) -> None:
        """Build. A tree that is installed as it is has none: what runs there is what somebody installed."""
        super().run()
        if not self.editable_mode:
            path = Path(self.build_lib) / "service" / NAME
            path.write_text(bill_of_materials(ROOT), encoding="utf-8")


setup(cmdclass={"build_py": BuildWithBill})
