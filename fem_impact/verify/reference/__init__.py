"""Reference solutions by independent means: numpy and scipy only, nothing of the solver."""
