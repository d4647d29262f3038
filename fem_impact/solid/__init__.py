"""The explicit finite-element model: items, state, time loop, observers."""
