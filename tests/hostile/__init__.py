"""A relay that answers with nonsense, against our client and against the whole service.

python -m tests.hostile --cases 100000 --seed 1: most cases against client processes, and a part through a
running service with good relays beside the hostile ones. Every case has
a number; seed and number make it again.
"""
