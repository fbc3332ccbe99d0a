"""The execution of a study on other machines."""
