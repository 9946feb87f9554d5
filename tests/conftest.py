"""What holds for all tests."""

from hypothesis import settings

# How long an example takes says more about what else the machine is doing: times are benchmarks' business.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")
