"""Rigid impulse-momentum theory of a projectile on a massive barrier."""
