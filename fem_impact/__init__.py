"""Where the energy of a dropped rod goes: explicit finite elements beside rigid theory."""
