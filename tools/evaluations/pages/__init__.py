"""What the evaluations publish: tables, plots, a page that links them."""
