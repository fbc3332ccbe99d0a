"""Study files: what a study is, checked where it enters."""
