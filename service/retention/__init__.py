"""How long what is stored is kept: deletions, rules with a dry run, and batches that let others write."""
