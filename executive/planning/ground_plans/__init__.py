"""Partial plans over ground actions: flaws, their resolvers, extraction of the finished plan."""
