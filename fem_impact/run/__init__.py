"""One call for every fidelity: a scene in, an Outcome out."""
