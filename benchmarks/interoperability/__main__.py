"""Runs every part and prints it as a table; ends with 1 when a check failed.

Without an argument it runs what the package registry gives, with a built source tree of libiec61850 its
programs too.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

from benchmarks.interoperability import our_client, stack_clients, stack_servers, their_clients
from benchmarks.interoperability.peers import PeerError, Result, Tree
from ied_sim import warm_up


def parts(tree: Tree | None) -> Iterator[tuple[str, Iterator[Result]]]:
    """Yield the parts with their titles."""
    yield "Clients of other stacks, our servers", stack_clients.results()
    yield "Our client, servers of other stacks", stack_servers.results()
    if tree is not None:
        yield "Our client and service, libiec61850's servers in C", our_client.results(tree)
        yield "libiec61850's clients in C, our servers", their_clients.results(tree)


def main(arguments: list[str]) -> int:
    """Print the tables and return the exit code."""
    if len(arguments) > 1 or not all(Path(each).is_dir() for each in arguments):
        sys.exit("python -m benchmarks.interoperability [TREE]: a built source tree of libiec61850")
    tree = Tree(Path(arguments[0]).resolve()) if arguments else None
    warm_up()
    failed = 0
    try:
        for title, results in parts(tree):
            print(f"\n{title}\n\n| server | asked | seen | |\n|---|---|---|---|")
            for result in results:
                failed += not result.passed
                verdict = "ok" if result.passed else "FAILED"
                print(f"| {result.server} | {result.asked} | {result.seen} | {verdict} |", flush=True)
    except PeerError as error:
        sys.exit(str(error))
    print(f"\n{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
