"""What a study is: the file that describes it, its design, and its cases."""
