"""Files written as a whole or not at all: text, bytes, fields over time, the directory of a run."""
