"""Which of the paper's claims hold in which readings of it: from tables of many universes."""
