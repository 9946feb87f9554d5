"""The motor control centre: collects recordings, has them diagnosed, keeps trends, answers over REST."""

import os

# Must come before numpy: its matrices are small here, and threads of its own only take the workers' cores.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
