"""Running a study: what comes next, on which cores or machines, and how long it will take."""
