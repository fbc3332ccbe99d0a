"""Object types, layouts and the rasterised arena."""
