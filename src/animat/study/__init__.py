"""The experiments of the paper and the settings files that describe them."""
