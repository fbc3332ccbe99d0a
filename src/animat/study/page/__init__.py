"""What the page on a study says of how it was asked and run."""
