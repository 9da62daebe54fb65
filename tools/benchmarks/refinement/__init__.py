"""What refinement costs and is worth: convergence of the solvers, and time of the proofs."""
