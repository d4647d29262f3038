"""What accuracy costs in time: the settings, their errors, and the choice of a setting."""
