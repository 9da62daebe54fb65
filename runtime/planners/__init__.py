"""Programs that run planners from Python packages as `PROGRAM DOMAIN PROBLEM`, like any external planner."""
