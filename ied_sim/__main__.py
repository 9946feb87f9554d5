"""`python -m ied_sim` is `ied-sim`."""

from ied_sim.cli import main

main()
