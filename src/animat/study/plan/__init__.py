"""The plan of a study: which lives there are, what they cost, whether they can be run."""
