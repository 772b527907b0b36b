"""What the bag of a demo tells: reading, judging, tables and pictures."""
