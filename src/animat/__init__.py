"""A laboratory for motivated robots."""
