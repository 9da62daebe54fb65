"""Feature spaces of the action models (Table 7): pure functions of action parameters, one definition for all uses."""
