"""What of a study is lived: its lives, numbered and cut into parts, and the tables of a part."""
