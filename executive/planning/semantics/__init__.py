"""What plans do: states, effects, validity, causal links, suffixes, completion. Shares nothing with the search."""
