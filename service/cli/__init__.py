"""The command line `mcc`, for people and scripts."""

from collections.abc import Sequence

from core.numerical_threads import use_one_thread


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns 0 done, 1 failed, 2 wrong use."""
    use_one_thread()
    # Imported here: with it comes numpy, which looks at the number of threads when it is loaded.
    from service.cli.app import main as run

    return run(arguments)


__all__ = ["main"]
