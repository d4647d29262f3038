"""Studies: many runs behind an executor, resumable, each result whole or absent."""
