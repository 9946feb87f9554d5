"""Tests of the speed that is seen in currents."""
