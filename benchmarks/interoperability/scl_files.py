"""Every SCL file of a folder: read, served over MMS, browsed, and what is offered compared with the file.

    python -m benchmarks.interoperability.scl_files DIR

One line an IED: what it holds, and whether the server's names and data sets are exactly those of the file.
"""

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import scl
from mms import MmsError
from scl.model_text import model_text
from testing.relays.browsing import contents_of_file, contents_of_server

SUFFIXES = (".icd", ".cid", ".iid", ".scd")


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder: Path = parser.parse_args().folder
    if not folder.is_dir():
        print(f"no folder {folder}: nothing to read")
        return 0
    faults = 0
    for path in sorted(folder.rglob("*")):
        if path.suffix.casefold() in SUFFIXES:
            for line, right in _verdicts(path):
                print(f"{path.relative_to(folder)}: {line}")
                faults += not right
    return 1 if faults else 0


def _verdicts(path: Path) -> Iterator[tuple[str, bool]]:
    start = time.perf_counter()
    try:
        document = scl.read(path)
    except scl.SclError as error:
        yield str(error), False
        return
    seconds = time.perf_counter() - start
    yield (
        (
            f"edition {document.header.edition}, {len(document.ieds)} IEDs, "
            f"{len(document.warnings)} warnings, read in {seconds:.2f} s"
        ),
        True,
    )
    for ied in document.ieds:
        if not ied.logical_devices:
            yield f"{ied.name}: no server", True
            continue
        try:
            found = contents_of_server(model_text(document, ied.name))
        except (scl.SclError, MmsError) as error:
            yield f"{ied.name}: {error}", False
            continue
        wanted = contents_of_file(path, ied.name)
        right = found == wanted
        yield (
            (
                f"{ied.name}: {len(wanted.names)} logical devices, "
                f"{sum(map(len, wanted.names.values()))} names, {len(wanted.data_sets)} data sets, "
                f"{'the same' if right else 'NOT the same'} on the server"
            ),
            right,
        )


if __name__ == "__main__":
    sys.exit(main())
