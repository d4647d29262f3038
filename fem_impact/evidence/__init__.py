"""What the project shows of itself: studies, problems with known answers, hard cases, the publication."""
