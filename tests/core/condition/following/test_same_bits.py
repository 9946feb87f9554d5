"""A follower's state has the same bits in every process, whether its code was compiled there or before."""

import importlib
import pkgutil

from numba.core.registry import CPUDispatcher

import core.condition


def test_no_sum_of_a_condition_is_reordered_by_the_compiler() -> None:
    """With numba's fast math, code from the cache and code compiled anew differ in the last bit."""
    modules = [
        importlib.import_module(module.name)
        for module in pkgutil.walk_packages(core.condition.__path__, "core.condition.")
    ]
    compiled = {
        name: one
        for module in modules
        for name, one in vars(module).items()
        if isinstance(one, CPUDispatcher)
    }
    assert len(compiled) > 10
    assert [name for name, one in compiled.items() if one.targetoptions.get("fastmath")] == []
