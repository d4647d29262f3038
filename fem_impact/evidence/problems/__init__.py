"""Problems with known answers, run through the solver's own parts."""
