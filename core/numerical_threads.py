"""How many threads the library of linear algebra has in each process."""

import os
from typing import Final

ONE_THREAD: Final = {"OPENBLAS_NUM_THREADS": "1"}


def use_one_thread() -> None:
    """Have one, unless the environment says otherwise. To be called before numpy is imported.

    It holds for this process and for those that it starts.

    Matrices are small here, and there is a worker for each core: more threads only wait for each other, which
    takes processor time too.
    """
    for name, number in ONE_THREAD.items():
        os.environ.setdefault(name, number)
