"""Files: written whole or not at all, locked, checksummed, and checked where they are read."""
