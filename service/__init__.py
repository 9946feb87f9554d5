"""The motor control centre: collects recordings, has them diagnosed, keeps trends, answers over REST."""

import os

# Must come before numpy, here and in every process started from here: with threads of their own for matrices
# this small, two workers on two cores wait for each other and take five times as long.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
