"""Survival statistics, verdicts, figures and the page."""
