"""`ied-sim` that writes the stacks of all its threads to stderr on SIGUSR1."""

import faulthandler
import signal

from ied_sim.cli import main

if __name__ == "__main__":
    faulthandler.register(signal.SIGUSR1, all_threads=True)
    main()
