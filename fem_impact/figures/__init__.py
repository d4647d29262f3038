"""Figures of runs and studies; each writes the numbers it shows as CSV beside itself."""
