"""Scenes that are hard on the solver: each closes its balances, is refused, or is stopped with the reason."""
