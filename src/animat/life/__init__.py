"""One step, one life, many lives, and what is recorded of them."""
