"""Which files changed, and which modules that changes."""

import subprocess
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Final

TEXT: Final = (".css", ".html", ".js", ".py")
"""Files that name others of the tree: templates, scripts, modules."""


def changed_files(root: Path, since: str | None = None) -> list[str]:
    """Return the files that differ from where the branch left main, with those that git does not know yet.

    since: another commit to compare with.
    """
    base = since or _git(root, "merge-base", "main", "HEAD")[0]
    changed = _git(root, "diff", "--name-only", "--no-renames", base)
    return sorted({*changed, *_git(root, "ls-files", "--others", "--exclude-standard")})


def _git(root: Path, *arguments: str) -> list[str]:
    ended = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=True)
    return ended.stdout.splitlines()


def module_of(file: str) -> str | None:
    """Return the name of the module in a file; None where it is none."""
    path = PurePosixPath(file)
    if path.suffix != ".py":
        return None
    parts = path.with_suffix("").parts
    parts = parts[1:] if parts[0] == "client" else parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def changed_modules(files: Iterable[str], known: Collection[str], texts: Mapping[str, str]) -> set[str]:
    """Return the modules that a change of files changes.

    A file that is no module changes those that name it, themselves or by way of others: a template changes
    the module that fills it.  known: all modules.  texts: what files that may name others say.
    """
    found: set[str] = set()
    seen: set[str] = set()
    waiting = list(files)
    while waiting:
        file = waiting.pop()
        module = module_of(file)
        if file in seen:
            continue
        seen.add(file)
        if module is None:
            waiting += _naming(file, texts)
            continue
        while module and module not in known:  # one that is gone: its package is another now
            module = module.rpartition(".")[0]
        found |= {module} if module else set()
    return found


def _naming(file: str, texts: Mapping[str, str]) -> list[str]:
    """Return the files that name one by its folder and name, or beside it as scripts do."""
    path = PurePosixPath(file)
    name, beside = "/".join(path.parts[-2:]), f'"./{path.name}"'
    return [
        other
        for other, text in texts.items()
        if name in text or (beside in text and PurePosixPath(other).parent == path.parent)
    ]


def texts_of(root: Path) -> dict[str, str]:
    """Return the files of the tree that may name others."""
    return {
        file: (root / file).read_text(encoding="utf-8")
        for file in _git(root, "ls-files", "--cached", "--others", "--exclude-standard")
        if file.endswith(TEXT) and (root / file).is_file()
    }
