"""What the arm has written: tracks out of messages, what can be measured on them, and writing in lock-step."""
