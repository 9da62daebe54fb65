"""What refinement minimises: sequences of instantiated actions and their predicted cost."""
