"""The documentation as a site, which the service shows under /help. MkDocs makes it, as mkdocs.yml says."""

import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path("service/web/help/site")
"""Where it lies in the source tree and in the wheel."""


class HelpSiteError(RuntimeError):
    """A page or a link is wrong; the words of MkDocs are in the message."""


def build(root: Path, folder: Path) -> None:
    """Make the site of a source tree in a folder; what was there goes. Raises HelpSiteError."""
    command = [sys.executable, "-m", "mkdocs", "build", "--strict"]  # --quiet hides warnings from --strict
    where = ["--config-file", str(root / "mkdocs.yml"), "--site-dir", str(folder.absolute())]
    quiet = {"NO_MKDOCS_2_WARNING": "1"}  # the theme's news of its successor
    ended = subprocess.run(  # noqa: S603 - our own interpreter and files
        [*command, *where], env={**os.environ, **quiet}, capture_output=True, text=True, check=False
    )
    if ended.returncode:
        found = ended.stdout + ended.stderr
        raise HelpSiteError(f"{root / 'docs'}: expected pages of which a site can be made, found:\n{found}")
