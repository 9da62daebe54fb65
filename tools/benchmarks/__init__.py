"""What `tailor bench` measures, one module each, with `configure(parser)` and `run(arguments)`."""
