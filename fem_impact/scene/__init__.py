"""The scene: a typed, checked statement of one impact, from a TOML file or from Python."""
