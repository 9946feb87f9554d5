"""How many files this process may have open at once; sockets count as files."""

import resource


def allow_open_files(wanted: int) -> int:
    """Ask the system for so many open files.

    Parameters
    ----------
    wanted : int
        Number of files that this process may want to have open at once.

    Returns
    -------
    int
        Number that the system allows; more than `wanted` where it allows more anyway.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
    if soft != resource.RLIM_INFINITY and soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
        return most
    return wanted if soft == resource.RLIM_INFINITY else soft
