"""Tests against peers that do not stand on libiec61850."""
