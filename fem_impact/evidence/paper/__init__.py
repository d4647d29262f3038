"""The paper by rigid theory: audit of its tables, its figures, own data, and an assessment."""
