"""The execution of a study: its shards, in which order, and what becomes of them."""
