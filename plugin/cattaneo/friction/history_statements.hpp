#pragma once

#include <cattaneo/friction/load_history.hpp>
#include <cattaneo/friction/march.hpp>
#include <string>

namespace cattaneo
{

/** Reads a load history in the form in which users of the programs write it: points separated
    by semicolons, at times 0, 1, 2, …: "P=0; P=1; Q=0.1; Q=-0.1". A pattern that is not named
    keeps its value; all are 0 at the first point. A name that holds spaces, commas, = or
    semicolons stands in quotes, ' or ": "'bolt 1, w = 1'=1 T=0.2". Without text: all from 0 to
    1. The history has no cycle.

    @param called what the text is called in an error, the name of an option for instance
    InputError, which quotes the point, for a value that is no number, a pattern that the
    problem does not have or that is named twice, a quote without an end, and a load at the
    first point. */
LoadHistory load_history(const std::string &called, const std::string &text,
                         const ReducedProblem &problem);

/** For a march that found no equilibrium: a sentence if no load pressed the bodies together in
    its last state, with the loads of the history that come later; else empty.
    @param bolts  names of loads that tighten bolts */
std::string nothing_presses(const ReducedProblem &problem, const LoadHistory &history,
                            const MarchReport &report, const ContactState &state,
                            const std::vector<std::string> &bolts = {});

} // namespace cattaneo
