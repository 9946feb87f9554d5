"""Runs both parts and prints them as tables; ends with 1 when a check failed."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.interoperability import our_client, their_clients
from benchmarks.interoperability.peers import PeerError, Result, Tree
from ied_sim import warm_up

PARTS: tuple[tuple[str, Callable[[Tree], Iterator[Result]]], ...] = (
    ("Our client and service, servers in C", our_client.results),
    ("Clients in C, our servers", their_clients.results),
)


def main(arguments: list[str]) -> int:
    if len(arguments) != 1 or not Path(arguments[0]).is_dir():
        sys.exit("python -m benchmarks.interoperability TREE: a built source tree of libiec61850")
    tree = Tree(Path(arguments[0]).resolve())
    warm_up()
    failed = 0
    try:
        for title, part in PARTS:
            print(f"\n{title}\n\n| server | asked | seen | |\n|---|---|---|---|")
            for result in part(tree):
                failed += not result.passed
                verdict = "ok" if result.passed else "FAILED"
                print(f"| {result.server} | {result.asked} | {result.seen} | {verdict} |", flush=True)
    except PeerError as error:
        sys.exit(str(error))
    print(f"\n{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
