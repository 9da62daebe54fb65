"""Models and data sets as folders of the Hugging Face hub: cards, checksums, push and pull (extra `hub`)."""
