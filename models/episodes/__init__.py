"""Data sets of episodes, and the training examples made from them."""
