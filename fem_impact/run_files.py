"""Names of the files in the directory of a run."""

__all__ = ["CHECKPOINT", "COMPUTED"]

CHECKPOINT = "run.checkpoint"
COMPUTED = (CHECKPOINT, "outcome.json", "contacts.csv", "history.csv", "fields.vtkhdf")
"""What a run computes; its scene, and what is made of these, lie beside them."""
