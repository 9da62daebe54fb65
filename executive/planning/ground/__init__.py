"""From PDDL values to a ground task: ground actions, conditions, and the additive heuristic over them."""
