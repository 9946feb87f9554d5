"""The conditions of motors: records taken in, folds, what they found, and the events told of motors."""
