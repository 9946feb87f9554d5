"""A network namespace of a test's own, in which it may make interfaces."""

import subprocess

from testing.not_installed import not_installed

IN_NAMESPACE = ("unshare", "--user", "--map-root-user", "--net")
"""Runs the command behind it there."""


def require_network_namespace() -> None:
    """Skip the test where the kernel refuses one, and fail in CI; a missing iproute2 is no reason to skip."""
    if subprocess.run([*IN_NAMESPACE, "true"], capture_output=True, check=False).returncode:
        not_installed(
            "no network namespace: sysctl kernel.apparmor_restrict_unprivileged_userns=0, or a container "
            "that may make user namespaces"
        )
