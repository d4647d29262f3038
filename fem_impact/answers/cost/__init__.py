"""What accuracy costs in time: the ladder of settings, its errors, and the choice of a setting."""
