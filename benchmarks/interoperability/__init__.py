"""Interoperability with libiec61850's example programs in C: python -m benchmarks.interoperability TREE.

TREE is a source tree of libiec61850 in which its library and examples have been built, as its own
instructions say. Part one: our client and the whole service against its servers. Part two: its client tools,
and c_client.c linked against its library, against every relay profile of our simulator.
"""
