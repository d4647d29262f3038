"""The physical effects, an item each: the number that says whether it matters and the slots that it fills."""
