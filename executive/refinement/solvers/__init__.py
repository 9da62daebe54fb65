"""Solvers behind one interface: chain solver, differential evolution, genetic algorithm."""
