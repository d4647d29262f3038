"""Known answers, found without the solver."""
