"""Why a subgoal was chosen, as values."""
