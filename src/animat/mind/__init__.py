"""Homeostasis, drives, selection of behaviour and affordance networks."""
