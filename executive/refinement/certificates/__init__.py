"""Lower bounds on the cost of every choice, by branch and bound."""
