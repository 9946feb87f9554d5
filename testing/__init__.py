"""What tests and benchmarks share: motors and reference physics, relays to talk to, a service in processes.

It is no part of the installed product: it runs from the source tree, with the packages of the `dev` extra.
"""
