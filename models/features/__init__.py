"""Feature spaces of action models (Table 7), on numbers and on intervals."""
