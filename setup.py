"""The build of the wheel, beside pyproject.toml: it puts a bill of materials and help pages into it."""

import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).parent
sys.path.insert(0, str(ROOT))  # a build front end does not

from release.bill_of_materials import NAME, bill_of_materials  # noqa: E402 - needs the path
from release.help_site import FOLDER, build  # noqa: E402 - needs the path


class BuildWithBillAndHelp(build_py):
    """Copy the packages, and write beside them what is made of other files of the tree."""

    def run(self) -> None:
        """Build. A tree that is installed as it is has no bill: there runs what somebody installed."""
        super().run()
        if not self.editable_mode:
            made = Path(self.build_lib)
            (made / "service" / NAME).write_text(bill_of_materials(ROOT), encoding="utf-8")
            build(ROOT, made / FOLDER)


setup(cmdclass={"build_py": BuildWithBillAndHelp})
