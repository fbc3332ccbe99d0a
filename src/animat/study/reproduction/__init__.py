"""The reproduction of the paper: its experiments, its claims, and what is published of them."""
