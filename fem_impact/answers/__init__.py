"""What a user asks of a scene: a verdict, a sweep, a comparison, its cost, a wanted error."""
