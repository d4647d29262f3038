"""What a scene calls for: active effects, filled slots, zones, sizes, refusals."""
