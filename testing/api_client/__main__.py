"""Make the typed client anew: python -m testing.api_client [--check].

--check writes nothing, and ends with 1 where the client is not what the API gives.
"""

import sys

from testing.api_client.making import PACKAGE, written_modules


def main() -> int:
    made = written_modules()
    stale = [name for name, text in made.items() if (PACKAGE / name).read_text(encoding="utf-8") != text]
    if "--check" in sys.argv:
        for name in stale:
            print(f"{PACKAGE.name}/{name} is not what the API gives: run make client")  # noqa: T201
        return 1 if stale else 0
    for name in stale:
        (PACKAGE / name).write_text(made[name], encoding="utf-8")
    print(f"written anew: {', '.join(stale) or 'nothing'}")  # noqa: T201
    return 0


if __name__ == "__main__":
    sys.exit(main())
