"""Pictures of action models, and of their evaluation."""
