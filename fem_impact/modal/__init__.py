"""The reduced model: free modes of the rod, a local contact law with friction, repeated contacts."""
