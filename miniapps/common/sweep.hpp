#pragma once

#include <string>

namespace miniapp
{

class Study;

/** Runs of a study with other values, and a table of their results. Checks keys and values of
    all runs. Then the package cattaneo_show, which does the runs, replaces this program: the
    function does not return. InputError for keys and values that no option allows, and without
    Python. On one rank only. @param name of the study
    @param statements "friction=0.2 0.5; order=1:4:4" */
void run_sweep(const Study &study, const std::string &name, const std::string &statements);

} // namespace miniapp
