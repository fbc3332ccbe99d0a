"""`python -m animat` is the command line."""

from animat.cli import main

main()
