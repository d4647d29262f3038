"""Films of the waves in the rod, drawn off screen from field files."""
