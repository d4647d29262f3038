"""The one record of a run for every fidelity: typed groups, written as flat JSON in SI units."""
