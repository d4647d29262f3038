"""Tables: one form, written for terminal, Markdown, HTML and CSV."""
