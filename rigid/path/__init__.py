"""The resolved sliding path: Coulomb friction with stick and reversal, in the impulse domain."""
