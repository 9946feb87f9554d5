"""The process that sets one report: `python -m service.reports.typesetting.typesetter`.

It reads the data as JSON, writes the PDF, and ends. So what typst keeps in memory ends, too, and a report
that takes too long can be stopped.
"""

import resource
import sys
from pathlib import Path

import typst

PROGRAM = Path(__file__).with_name("report.typ")
MOST_MEMORY_BYTES = 4 << 30
"""Of addresses, which are more than what is used."""


def main() -> int:
    """Set the report; return 1 where that cannot be done, with the reason on stderr."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    report = sys.stdin.buffer.read().decode()
    try:
        made = typst.compile(PROGRAM.read_bytes(), format="pdf", sys_inputs={"report": report})
    except (RuntimeError, ValueError) as error:
        sys.stderr.write(f"{error}\n")
        return 1
    sys.stdout.buffer.write(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
