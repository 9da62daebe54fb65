"""Options, input and output of `tailor plan`."""
