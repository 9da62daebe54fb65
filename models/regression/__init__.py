"""Regressors beside model trees: networks, stacks, the choice of the best, and prediction intervals."""
