"""Tests of programs that a developer's machine may lack, and CI's may not."""

import os
from typing import NoReturn

import pytest


def not_installed(reason: str) -> NoReturn:
    """Skip the test, and fail where CI=true. reason: what is missing, and how to install it."""
    if os.environ.get("CI") == "true":
        pytest.fail(reason)
    pytest.skip(reason)
