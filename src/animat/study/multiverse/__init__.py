"""The multiverse of the paper: every reading of it lived, and what comes of each claim."""
