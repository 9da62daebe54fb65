"""From a plan to an optimised sequence of actions: instantiation, assertion, refinement (paper 6 and 7)."""
