"""Finite-element operators: the weak forms of the model and what is assembled from them."""
