#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <string>

namespace cattaneo
{

/// Writes a reduced problem as JSON, from which every double is restored to the last bit.
/// InputError, before anything is written, if the problem is not valid or a name is not UTF-8.
/// InputError also if the file cannot be written.
void save(const ReducedProblem &problem, const std::string &file);

/// Reads what save() wrote. InputError if the file is missing, is not a valid reduced
/// problem or has a key that its format does not know.
ReducedProblem load_reduced_problem(const std::string &file);

} // namespace cattaneo
