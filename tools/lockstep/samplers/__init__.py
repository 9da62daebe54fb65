"""How each robot tries an action out in lock-step: what is drawn, how the world is set, what counts as a failure."""
