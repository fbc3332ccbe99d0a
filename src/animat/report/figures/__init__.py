"""The figures, one to a file. None of them touches pyplot or any other global state for long."""
