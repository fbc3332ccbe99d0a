"""Results directories: what stands in one, who holds it, whether it is whole."""
