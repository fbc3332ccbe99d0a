"""The experiments: the reproduction of the paper, its multiverse, its sensitivity."""
