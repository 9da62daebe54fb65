"""Lower bounds on the cost of any choice, by branch and bound."""
