"""Pictures of runs: what they are drawn from (tracks) and how."""
