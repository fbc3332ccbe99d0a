"""Random streams and elementary functions: the ground everything stands on."""
