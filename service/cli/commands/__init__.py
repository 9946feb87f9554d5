"""The commands of `mcc`. Each imports its module when it runs, so that `--help` is fast."""
