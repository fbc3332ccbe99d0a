"""Recordings: a life in a file, from which it can be looked at, verified and resumed."""
