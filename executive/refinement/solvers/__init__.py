"""Optimisers behind one interface: exact chain search, differential evolution, genetic algorithm."""
